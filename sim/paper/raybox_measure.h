// One scene through everything that "Ray-Box Culling for Tree Structures" evaluates: kd-trees of five leaf sizes, with
// ray-box culling and without, and the same culling in the leaves of the 4-wide tree.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/accel/kd_tree.h"
#include "model/reference/kd_traversal.h"
#include "model/scene/scene.h"
#include "sim/paper/raybox_rays.h"

namespace ctu::sim::paper {

/// Rays whose hit with culling is not the one without, judged by exact arithmetic.
struct ChangedHits {
  std::uint64_t lost = 0, near_misses = 0, ties = 0;
};

/// A kd-tree of one leaf size.
struct KdResult {
  int leaf_size = 1;
  accel::KdStatistics tree, clipped_tree;
  double build_seconds = 0, clipped_build_seconds = 0;
  reference::KdCounts plain, culled;             ///< without and with ray boxes
  reference::KdCounts clipped, clipped_culled;   ///< of the tree with split clipping
  double plain_seconds = 0, culled_seconds = 0;  ///< processor time of the rays
};

/// The 4-wide tree of one leaf size. At a triangle's cost of 1 its builder stops at leaves of one or two.
struct WideResult {
  int leaf_size = 4;
  float triangle_cost = 1;
  std::uint64_t node_visits = 0, leaf_visits = 0, plain_tests = 0;
  cull::RayBoxCounts culled;
};

struct RayboxResult {
  std::string name;
  std::uint64_t triangles = 0, spheres = 0, rays = 0, shadow_rays = 0;
  int max_depth = 0;
  std::vector<KdResult> kd;
  std::vector<WideResult> wide;
  ChangedHits changed;  ///< of all trees with culling
};

RayboxResult measure_raybox(const scene::Scene& scene, const RayboxSetting& setting, int threads,
                            const std::function<void(std::uint64_t paths_done)>& progress);

}  // namespace ctu::sim::paper
