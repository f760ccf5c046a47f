// Whether rays have trees of their own: local trees for the lights that they run to (the ray-distribution paper).
#pragma once

namespace ctu::traces {

struct RayTrees {
  int most_areas = 0;  ///< influence areas, each with a local tree, that are looked for; 0: there is one tree for all

  bool any() const { return most_areas != 0; }
  bool operator==(const RayTrees&) const = default;
};

/// Throws Error on options out of range.
void check(const RayTrees& trees);

}  // namespace ctu::traces
