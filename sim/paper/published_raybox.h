// The numbers of the evaluation in "Ray-Box Culling for Tree Structures" (Nah, Park, Kang and Han, Journal of
// Information Science and Engineering, 2012): Tables 1 to 3. Figures 4 to 7 are made of them.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace ctu::sim::paper {

/// The paper's largest numbers of primitives in a leaf.
inline constexpr std::array<int, 5> kLeafSizes = {1, 4, 8, 16, 32};
inline constexpr std::size_t kLeafSizeCount = kLeafSizes.size();

/// A row of Table 2, numbers per ray and seconds.
struct PublishedCulling {
  double build_seconds, traversals, tests, culled_tests, created, updated, seconds, culled_seconds;
};

/// A row of Table 3.
struct PublishedTree {
  double nodes, references;
};

struct PublishedRaybox {
  const char* name;
  int primitives, depth;
  std::array<PublishedCulling, kLeafSizeCount> culling;
  std::array<PublishedTree, kLeafSizeCount> trees;
  double box_kilobytes;
};

/// Balls, Killeroo, Buddha, Sponza with direct lighting and with path tracing.
std::span<const PublishedRaybox> published_raybox();

}  // namespace ctu::sim::paper
