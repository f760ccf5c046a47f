// One scene under one light through everything the ray-distribution paper evaluates: the rays to the light, the
// influence areas found from them, the trees by each heuristic, what they were predicted to cost and what they do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/influence/find_areas.h"
#include "model/influence/tree_set.h"
#include "model/scene/scene.h"
#include "sim/paper/raydist_lights.h"
#include "traces/ray_options.h"

namespace ctu::sim::paper {

/// A heuristic that is compared; the first is what the others are held against.
struct NamedHeuristic {
  std::string name;
  influence::TreeHeuristic heuristic;
  bool by_light = false;  ///< shown for each scene and light, not only as a mean
};
const std::vector<NamedHeuristic>& compared_heuristics();
inline constexpr std::size_t kBaseline = 0;  ///< LSPH + SAH
std::size_t chosen_heuristic();              ///< that the local trees of a selecting traversal are built by

/// 4-wide box tests and triangle tests of a ray, and how a tree came to them.
struct HeuristicResult {
  double build_seconds = 0;        ///< processor time of one thread
  double surface_predicted = 0;    ///< by the surface areas of the boxes
  double projected_predicted = 0;  ///< by their projected areas
  double crossing = 0;             ///< measured: uniform affine rays from end to end of the area, all they meet
  double closest = 0;              ///< ... up to the first hit
  double shadow = 0;               ///< measured: the recorded shadow rays of the area, up to any hit
  int depth = 0;
};

/// The whole scene with local trees against the global tree alone.
struct SelectionResult {
  std::uint64_t rays = 0, affine = 0, final = 0;
  double global_cost = 0;     ///< of a shadow ray, without local trees
  double selecting_cost = 0;  ///< ... with
  double local_cost = 0;      ///< of a walk of a local tree
  double memory_ratio = 1;
  std::uint64_t changed = 0, lost = 0;  ///< closest hits that differ in a bit; of these, by exact arithmetic, lost
  /// Above this share of affine rays without a final answer, local trees cost more than they save.
  double threshold() const { return global_cost > 0 ? 1 - local_cost / global_cost : 0; }
};

struct LightResult {
  TestLight light;
  std::uint64_t shadow_rays = 0;
  std::size_t areas = 0;
  std::uint64_t claimed = 0, looked_at = 0;                     ///< shadow rays of some area, of those looked at
  influence::AreaKind found_kind = influence::AreaKind::Plane;  ///< of the largest area, which is compared
  std::uint64_t local_triangles = 0;
  std::vector<HeuristicResult> heuristics;  ///< in the order of compared_heuristics()
  SelectionResult selection;
};

struct RayDistributionOptions {
  traces::RayOptions rays;
  accel::BuildOptions build;
  std::uint64_t affine_rays = 4096;
  std::uint64_t most_shadow_rays = 4096;  ///< evenly from all
};

/// `global`: the tree over the whole scene by the baseline. Nothing is found where the light sees no ray (areas is 0).
LightResult measure_light(const scene::Scene& scene, const accel::Bvh4& global, const TestLight& light,
                          const RayDistributionOptions& options);

}  // namespace ctu::sim::paper
