// The tables of the ray-distribution paper, ours and the published values beside them, as Markdown.
#pragma once

#include <string>
#include <vector>

#include "sim/paper/raydist_measure.h"
#include "sim/paper/raydist_octree.h"

namespace ctu::sim::paper {

struct RayDistributionScene {
  std::string name;
  std::uint64_t triangles = 0;
  std::vector<LightResult> lights;
};

/// Mean error of a predicted cost against what all boxes on the way of uniform affine rays cost, percent: over all
/// heuristics, scenes and lights, or those whose largest area is of one kind.
struct PredictionError {
  double projected = 0, surface = 0;
  std::size_t cases = 0;
};
PredictionError prediction_error(const std::vector<RayDistributionScene>& scenes);
PredictionError prediction_error(const std::vector<RayDistributionScene>& scenes, influence::AreaKind kind);

/// Predicted against measured.
std::string prediction_table(const std::vector<RayDistributionScene>& scenes);
/// Each heuristic over all scenes and lights: cost against the baseline, build time, depth.
std::string heuristic_table(const std::vector<RayDistributionScene>& scenes);
/// Each scene and light: cost of shadow rays by some heuristics against the baseline.
std::string light_table(const std::vector<RayDistributionScene>& scenes);
/// Local trees in areas found from the rays, against the global tree alone.
std::string selection_table(const std::vector<RayDistributionScene>& scenes);

/// Looking up the areas of a point.
std::string lookup_table(const std::vector<LookupResult>& lookups);

/// All of them, with headings of the third level.
std::string raydist_report(const std::vector<RayDistributionScene>& scenes, const std::vector<LookupResult>& lookups);

}  // namespace ctu::sim::paper
