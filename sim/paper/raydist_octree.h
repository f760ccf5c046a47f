// Which areas contain a point: by the octree and by asking each area, over their number.
#pragma once

#include <cstdint>
#include <vector>

namespace ctu::sim::paper {

struct LookupResult {
  int areas = 0;
  std::size_t cells = 0;
  double containing = 0;                          ///< areas that certainly contain a point, on average
  double named = 0;                               ///< areas that the octree names for it
  double octree_seconds = 0, linear_seconds = 0;  ///< processor time of a lookup with the test of what it names
  bool agree = true;                              ///< both found the same areas for every point
};

/// Random boxes and frusta, about half as wide as the cube that they and the points lie in.
std::vector<LookupResult> measure_lookups(std::uint64_t seed);

}  // namespace ctu::sim::paper
