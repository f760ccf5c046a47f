// When a ray reaches one plane across an axis, enclosed: the arithmetic of the slab test (slab_test.cpp has why it
// encloses) for a plane at a time.
#pragma once

#include "model/intersect/ray.h"
#include "model/numeric/round.h"

namespace ctu::intersect {

struct PlaneTime {
  float down, up;  ///< the exact t lies between them
};

/// For an axis along which the valid ray moves; the plane is finite.
inline PlaneTime plane_time(const PreparedRay& ray, int axis, float plane) {
  using numeric::Round;
  const bool backwards = (ray.negative_axes >> axis & 1) != 0;
  // Mirrored where the ray runs backwards: exact, and the direction is positive then.
  const float to = backwards ? -plane : plane, from = backwards ? -ray.ray.origin[axis] : ray.ray.origin[axis];
  const float slow = backwards ? -ray.rcp_up[axis] : ray.rcp_down[axis];
  const float fast = backwards ? -ray.rcp_down[axis] : ray.rcp_up[axis];
  if (to == from) return {0, 0};
  const float near = numeric::sub<Round::Down>(to, from), far = numeric::sub<Round::Up>(to, from);
  return {numeric::mul<Round::Down>(near, near >= 0 ? slow : fast),
          numeric::mul<Round::Up>(far, far >= 0 ? fast : slow)};
}

}  // namespace ctu::intersect
