// Ray against four boxes: per axis the ray's t at the two faces, rounded outward, and their overlap
// with the ray's own [tmin, tmax]. Never loses a box that the ray meets in exact arithmetic (DESIGN section 5).
#pragma once

#include <cstdint>

#include "model/intersect/ray.h"

namespace ctu::intersect {

inline constexpr int kLanes = 4;

/// Four boxes side by side: lo[axis][lane], hi[axis][lane]. An empty lane has lo = +inf, hi = -inf.
struct alignas(16) Box4 {
  float lo[3][kLanes];
  float hi[3][kLanes];
};

/// Where the ray meets each box's face planes, enclosed: the exact t of the plane the ray reaches first on
/// `axis` lies in [near_down, near_up], of the other in [far_down, far_up]. On an axis the ray does not
/// move along they are [-inf, -inf] and [+inf, +inf] when the origin lies within the closed slab;
/// otherwise the lane misses. No NaN occurs.
struct alignas(16) SlabTimes {
  float near_down[3][kLanes], near_up[3][kLanes];
  float far_down[3][kLanes], far_up[3][kLanes];
  float t0[kLanes];  ///< max(tmin, near_down...): at or before the exact entry
  float t1[kLanes];  ///< min(tmax, far_up...): at or after the exact exit
  std::uint8_t hit;  ///< bit lane: t0 <= t1 and the lane is not empty
};

/// All bounds, for the culling designs that locate cells; `tmax` is the ray's best hit so far.
SlabTimes slab_test(const PreparedRay& ray, const Box4& boxes, float tmax);

/// Only t0, t1 and hit are filled: what a unit without culling needs. The same bits as slab_test gives.
void slab_test_outer(const PreparedRay& ray, const Box4& boxes, float tmax, SlabTimes& out);

}  // namespace ctu::intersect
