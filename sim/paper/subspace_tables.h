// The tables of the subspace culling paper's evaluation, ours and the published values beside them, as Markdown.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/paper/published_subspace.h"
#include "sim/paper/subspace_measure.h"

namespace ctu::sim::paper {

struct SceneResult {
  std::string name;
  std::uint64_t triangles = 0, nodes = 0;
  std::array<ResolutionResult, kResolutions.size()> at;  ///< in the order of kResolutions
};

/// Steps between Table 1's columns further apart than this are set in bold.
inline constexpr double kAgreementPoints = 3;

/// The scenes, what of the paper each is held against, their rays and the hits that changed.
std::string scene_table(const std::vector<SceneResult>& results);
/// Table 1 at kResolutions[r].
std::string ratio_table(const std::vector<SceneResult>& results, std::size_t r);
/// The steps between Table 1's columns, ours and the paper's, for scenes that have a counterpart.
std::string step_table(const std::vector<SceneResult>& results);
/// Table 2 at kResolutions[r].
std::string time_table(const std::vector<SceneResult>& results, std::size_t r);
/// Section 4.2: making the ray mask tables.
std::string table_making_table(const std::vector<const RayTables*>& tables);
/// Table 3.
std::string search_table(const std::vector<SceneResult>& results);
/// Fig. 8 at kResolutions[r]: intersections, and the time to make the masks.
std::string level_table(const std::vector<SceneResult>& results, std::size_t r);

/// All of them, with headings of the third level.
std::string report(const std::vector<SceneResult>& results, const std::vector<const RayTables*>& tables);

}  // namespace ctu::sim::paper
