// A box test that is cheap and passes every box of a triangle that triangle_test accepts.
//
// Let D bound |v - o| of every vertex of the scene on every axis, and u = 2^-24. The shear of triangle_test is off by at
// most 6.1 u D (subtraction u, product 3 u, difference 2 u, and higher orders), and its edge signs are exact; so where
// it accepts, the exact ray passes the exact triangle's plane within 6.1 u D of it, at a parameter that differs from the
// computed t by at most 6 u D / |d_kz|. Here a direction is scaled by a power of two to 1 <= |d_kz| < 2; then moving
// the origin along an axis by 32 u D moves that axis' near and far t apart by at least 16 u D each: room for the
// shear's error (6.1), that of t (6) and this test's own three roundings (3). A component of the direction below 2^-60
// is taken for 2^-60: over the scene's extent that moves the ray by 2^-58 D at most. So there is no division by zero
// and no NaN.
#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <cmath>

#include "model/accel/bvh4.h"
#include "model/intersect/ray.h"

namespace ctu::reference {

/// What both forms below share: the scaled ray in the number type they compute with.
template <class Number>
struct PaddedRay {
  Number reciprocal[3];
  Number near_origin[3], far_origin[3];
  Number tmin;
  Number scale;  ///< t in the scaled direction's units = t * scale
  bool negative[3];
};

/// The largest |v - o| on any axis that a vertex within the scene's bounds can have.
inline double reach(const accel::Bvh4& bvh, const Vec3& origin) {
  double d = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = origin[axis];
    d = std::max({d, std::fabs(bvh.lower[axis] - o), std::fabs(bvh.upper[axis] - o)});
  }
  return d;
}

template <class Number>
PaddedRay<Number> pad(const intersect::Ray& ray, Number reach, Number largest_component) {
  constexpr Number kUnit = Number(0x1p-24);
  PaddedRay<Number> p;
  const int exponent = std::ilogb(largest_component);
  p.scale = std::scalbn(Number(1), exponent);
  const Number shrink = std::scalbn(Number(1), -exponent);
  p.tmin = Number(ray.tmin) * p.scale;
  const Number farthest = std::max({std::fabs(ray.origin.x), std::fabs(ray.origin.y), std::fabs(ray.origin.z)});
  const Number padding = 32 * kUnit * reach + 2 * kUnit * farthest;  // the second term covers the origin's rounding
  for (int axis = 0; axis < 3; ++axis) {
    const Number d = Number(ray.direction[axis]) * shrink;
    p.negative[axis] = std::signbit(d);  // of -0 too, as copysign sees it
    const Number moved = std::copysign(padding, d);
    p.reciprocal[axis] = 1 / std::copysign(std::max(std::fabs(d), Number(0x1p-60)), d);
    p.near_origin[axis] = Number(ray.origin[axis]) + moved;
    p.far_origin[axis] = Number(ray.origin[axis]) - moved;
  }
  return p;
}

/// Four lanes of binary32, for rays and scenes whose numbers are far from its limits.
class FastBoxes {
 public:
  using Distance = float;

  explicit FastBoxes(const PaddedRay<float>& p) : tmin_(_mm_set1_ps(p.tmin)), scale_(p.scale) {
    for (int axis = 0; axis < 3; ++axis) {
      reciprocal_[axis] = _mm_set1_ps(p.reciprocal[axis]);
      near_origin_[axis] = _mm_set1_ps(p.near_origin[axis]);
      far_origin_[axis] = _mm_set1_ps(p.far_origin[axis]);
      near_row_[axis] = 4 * axis + (p.negative[axis] ? 12 : 0);
      far_row_[axis] = 4 * axis + (p.negative[axis] ? 0 : 12);
    }
  }

  Distance limit(float t) const { return t * scale_; }

  /// Bit lane: the box may be met before `limit`; then t[lane] is not after the first meeting.
  unsigned test(const intersect::Box4& boxes, Distance limit, Distance* t) const {
    const float* const rows = &boxes.lo[0][0];
    const __m128 near =
        _mm_max_ps(_mm_max_ps(near_plane(rows, 0), near_plane(rows, 1)), _mm_max_ps(near_plane(rows, 2), tmin_));
    const __m128 far = _mm_min_ps(_mm_min_ps(far_plane(rows, 0), far_plane(rows, 1)),
                                  _mm_min_ps(far_plane(rows, 2), _mm_set1_ps(limit)));
    _mm_store_ps(t, near);
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(near, far)));
  }

 private:
  __m128 near_plane(const float* rows, int axis) const {
    return _mm_mul_ps(_mm_sub_ps(_mm_load_ps(rows + near_row_[axis]), near_origin_[axis]), reciprocal_[axis]);
  }
  __m128 far_plane(const float* rows, int axis) const {
    return _mm_mul_ps(_mm_sub_ps(_mm_load_ps(rows + far_row_[axis]), far_origin_[axis]), reciprocal_[axis]);
  }

  __m128 reciprocal_[3], near_origin_[3], far_origin_[3], tmin_;
  int near_row_[3], far_row_[3];
  float scale_;
};

/// The same in binary64, whose range no scene of binary32 leaves.
class WideBoxes {
 public:
  using Distance = double;

  explicit WideBoxes(const PaddedRay<double>& p) : p_(p) {}

  Distance limit(float t) const { return t * p_.scale; }

  unsigned test(const intersect::Box4& boxes, Distance limit, Distance* t) const {
    unsigned hit = 0;
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      double near = p_.tmin, far = limit;
      for (int axis = 0; axis < 3; ++axis) {
        const double lo = boxes.lo[axis][lane], hi = boxes.hi[axis][lane];
        near = std::max(near, ((p_.negative[axis] ? hi : lo) - p_.near_origin[axis]) * p_.reciprocal[axis]);
        far = std::min(far, ((p_.negative[axis] ? lo : hi) - p_.far_origin[axis]) * p_.reciprocal[axis]);
      }
      t[lane] = near;
      if (near <= far) hit |= 1u << lane;
    }
    return hit;
  }

 private:
  PaddedRay<double> p_;
};

}  // namespace ctu::reference
