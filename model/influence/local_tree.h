// The tree of an influence area: over every primitive with a point in the area, built for the rays that run there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/accel/build.h"
#include "model/influence/area.h"
#include "model/influence/facing.h"

namespace ctu::influence {

/// What a box costs.
enum class TreeCost : std::uint8_t { SurfaceArea, ProjectedArea, Mixed };
/// Which axes a node is cut across.
enum class TreeAxes : std::uint8_t { All, Longest, LeastFacing };

struct TreeHeuristic {
  TreeCost cost = TreeCost::SurfaceArea;
  TreeAxes axes = TreeAxes::LeastFacing;
  FacingThresholds thresholds = kStrictThresholds;
  double surface_part = 0.25;  ///< of TreeCost::Mixed
};
/// What local trees are built by: within 1.5 points of the cheapest to traverse that was compared, and more level
/// (docs/results.md).
inline constexpr TreeHeuristic kLocalHeuristic{TreeCost::Mixed, TreeAxes::All};

/// "SPFH + SAH" and so on, as the paper names them.
std::string to_string(const TreeHeuristic& heuristic);

/// Ids of the primitives that may have a point in the area, ascending: none that has one is left out. A sphere may have
/// one when its box has.
std::vector<std::uint32_t> primitives_in(const scene::Mesh& mesh, const PreparedArea& area, int threads);

/// The tree over the triangles of `mesh`, by the heuristic for the rays of `area`.
accel::Bvh4 build_for(const scene::Mesh& mesh, const InfluenceArea& area, const TreeHeuristic& heuristic,
                      const accel::BuildOptions& options);

/// The same over some of the primitives, ascending ids and at least one: its leaves carry the ids that the whole mesh
/// gives them.
accel::Bvh4 build_for(const scene::Mesh& mesh, const std::vector<std::uint32_t>& primitives, const InfluenceArea& area,
                      const TreeHeuristic& heuristic, const accel::BuildOptions& options);

}  // namespace ctu::influence
