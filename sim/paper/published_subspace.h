// The numbers of the evaluation in "Subspace Culling for Ray-Box Intersection" (Yoshimura and Harada, Proc. ACM Comput.
// Graph. Interact. Tech. 6, 1, 2023), and which of its scenes ours can be held against.
#pragma once

#include <array>
#include <span>
#include <string>

namespace ctu::sim::paper {

/// The mask resolutions that the paper measures, R = 4 and 6.
inline constexpr std::array<int, 2> kResolutions = {4, 6};

/// Table 1, percent of the intersections without culling.
struct PublishedRatios {
  double ideal, lut, lut_double, compressed;  ///< ray mask LUT of R_ray = R and of 2R; 256 entries
};

/// Table 2, percent of the rendering time without culling.
struct PublishedTimes {
  double ideal, lut, lut_double;
};

/// Table 3, milliseconds to find the masks of all nodes in a compression LUT of 256 entries.
struct PublishedSearch {
  double naive, ours;
};

/// A row of the tables; arrays follow kResolutions.
struct PublishedScene {
  const char* name;
  std::array<PublishedRatios, 2> ratios;
  double seconds;  ///< Table 2, without culling
  std::array<PublishedTimes, 2> times;
  std::array<PublishedSearch, 2> search;
};

/// The nine scenes in the paper's order.
std::span<const PublishedScene> published_scenes();

/// Section 4.2: milliseconds to make the ray mask LUT, for R_ray = R and 2R.
struct PublishedTableTimes {
  double lut, lut_double;
};
inline constexpr std::array<PublishedTableTimes, 2> kPublishedTableTimes = {{{1.1, 54.2}, {29.6, 1791.7}}};

enum class Kinship {
  None,  ///< nothing in the paper is like it
  Like,  ///< the same kind of geometry, another model
  Same,  ///< the same model or a part of it
};
const char* to_string(Kinship kinship);

/// What of the paper one of our scenes is held against.
struct Counterpart {
  Kinship kinship = Kinship::None;
  const PublishedScene* scene = nullptr;  ///< null for Kinship::None
  const char* remark = "";                ///< what differs, as far as it is known
};

/// By the short name of our scene ("san-miguel", "gen:curly-hair"; the parameters of a generated scene do not matter).
Counterpart counterpart(const std::string& name);

}  // namespace ctu::sim::paper
