// The numbers of the ray-distribution paper (Falcone, "Ray Distribution Aware Heuristics for Bounding Volume
// Hierarchies Construction", 2024, in its finished form): means over its eight scenes, two kinds of areas and four
// orientations.
#pragma once

namespace ctu::sim::paper {

struct PublishedRayDistribution {
  // Mean error of the predicted traversal cost, percent.
  double projected_error = 7, surface_error = 36;
  double projected_error_plane = 2, projected_error_point = 12;
  double build_time_ratio = 10;                   ///< PAH's over SAH's
  double loose_cost = 110.5, strict_cost = 69.1;  ///< mean cost by the thresholds of SPFH
  double memory_ratio = 2.16;                     ///< all trees over one
};
inline constexpr PublishedRayDistribution kPublishedRayDistribution{};

/// The goal that ours is held against: PAH's error on affine rays, percent.
inline constexpr double kProjectedErrorGoal = 10;

}  // namespace ctu::sim::paper
