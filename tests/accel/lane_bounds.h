// Bounds of points, and those that a node states for a child.
#pragma once

#include <algorithm>
#include <limits>

#include "model/accel/bvh4.h"

namespace ctu::test {

struct Bounds {
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Vec3 lower{kInfinity, kInfinity, kInfinity}, upper{-kInfinity, -kInfinity, -kInfinity};
  void grow(const Vec3& v) {
    for (int a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], v[a]);
      upper[a] = std::max(upper[a], v[a]);
    }
  }
  bool operator==(const Bounds&) const = default;
};

inline Bounds lane_bounds(const accel::Node4& node, int lane) {
  Bounds bounds;
  for (int a = 0; a < 3; ++a) {
    bounds.lower[a] = node.boxes.lo[a][lane];
    bounds.upper[a] = node.boxes.hi[a][lane];
  }
  return bounds;
}

}  // namespace ctu::test
