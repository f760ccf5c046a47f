// The tree as the fast tracer walks it: eight children a node, made from the 4-wide tree by taking in the children of
// its largest child. Fewer steps a ray; the leaves are the same.
#pragma once

#include <vector>

#include "model/accel/bvh4.h"

namespace ctu::reference {

inline constexpr int kWideLanes = 8;

/// Empty lanes have lo = +inf, hi = -inf. An inner child's index is one into the same list.
struct alignas(32) Node8 {
  float lo[3][kWideLanes];
  float hi[3][kWideLanes];
  accel::ChildRef child[kWideLanes];
};

/// Node 0 is the root.
std::vector<Node8> widen(const accel::Bvh4& bvh);

}  // namespace ctu::reference
