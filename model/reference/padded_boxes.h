// A box test that is cheap and passes every box of a triangle that triangle_test accepts.
//
// Let D bound |v - o| of every vertex of the scene on every axis, d be the direction, kz its largest axis, u = 2^-24.
// The shear of triangle_test is off by at most 6.1 u D (subtraction u, product 3 u, difference 2 u, and higher orders),
// and its edge signs are exact; so where it accepts, the exact ray passes within 6.1 u D of the exact triangle, at a
// parameter that differs from the computed t by at most 6 u D / |d_kz|. Moving the origin by 40 u D along an axis a
// moves that axis' near and far t apart by 40 u D / |d_a| each: room for the shear's error (6.1), that of t (6) and the
// rounding of the products here (below 8 with that of D; what the origin itself loses is added in its own units).
// A component of d below 2^-60 |d_kz| is taken for that: over the scene's extent it moves the ray by 2^-59 D at most.
// So there is no division by zero, no overflow and no NaN.
//
// Where sphere_test accepts, the ray's point at its t lies within 24 u |v - o| + 8 u r of the sphere, which is at most
// 24 * 1.74 u D + 8 u D. Boxes of trees with spheres are padded twice as much.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/intersect/ray.h"
#include "model/reference/lanes8.h"
#include "model/reference/node8.h"

namespace ctu::reference {

/// What bounds a ray's rounding errors: D of the above, and the largest coordinate of the origin.
struct Reach {
  float distance = 0, origin = 0;

  Reach(const Vec3& lower, const Vec3& upper, const Vec3& o) {
    for (int axis = 0; axis < 3; ++axis) {
      distance = std::max({distance, std::fabs(lower[axis] - o[axis]), std::fabs(upper[axis] - o[axis])});
      origin = std::max(origin, std::fabs(o[axis]));
    }
  }
};

/// By how much D counts for more where there are spheres.
inline constexpr float kSphereReach = 2;

/// The t of a plane at coordinate x: x * reciprocal + near for the face met first, + far for the other.
template <class Number>
struct PaddedRay {
  Number reciprocal[3], near[3], far[3];
  bool negative[3];

  PaddedRay(const intersect::Ray& ray, const Reach& reach, int kz) {
    constexpr Number kUnit = Number(0x1p-24);
    const Number padding = 40 * kUnit * Number(reach.distance) + 4 * kUnit * Number(reach.origin);
    const Number smallest = std::fabs(Number(ray.direction[kz])) * Number(0x1p-60);
    for (int axis = 0; axis < 3; ++axis) {
      const Number d = Number(ray.direction[axis]), o = Number(ray.origin[axis]);
      const Number moved = std::copysign(padding, d);
      reciprocal[axis] = 1 / std::copysign(std::max(std::fabs(d), smallest), d);
      near[axis] = -(o + moved) * reciprocal[axis];
      far[axis] = -(o - moved) * reciprocal[axis];
      negative[axis] = std::signbit(d);  // of -0 too, as copysign sees it
    }
  }
};

/// Eight lanes of binary32, for rays and scenes whose numbers are far from its limits.
class FastBoxes {
 public:
  using Distance = float;

  /// Whether every product stays below 2^128. `kz` is the axis of the largest direction component.
  static bool fit(const intersect::Ray& ray, const Reach& reach, int kz) {
    const float dz = std::fabs(ray.direction[kz]);
    return reach.distance >= 0x1p-30f && reach.distance <= 0x1p30f && reach.origin <= 0x1p30f && dz >= 0x1p-30f &&
           dz <= 0x1p30f;
  }

  FastBoxes(const intersect::Ray& ray, const Reach& reach, int kz) : tmin_(splat8(ray.tmin)) {
    const PaddedRay<float> p(ray, reach, kz);
    for (int axis = 0; axis < 3; ++axis) {
      reciprocal_[axis] = splat8(p.reciprocal[axis]);
      near_[axis] = splat8(p.near[axis]);
      far_[axis] = splat8(p.far[axis]);
      near_row_[axis] = kWideLanes * (axis + (p.negative[axis] ? 3 : 0));
      far_row_[axis] = kWideLanes * (axis + (p.negative[axis] ? 0 : 3));
    }
  }

  /// Bit lane: the box may be met in [tmin, limit]; then t[lane] is not after the first meeting.
  [[gnu::always_inline]] unsigned test(const Node8& node, Distance limit, Distance* t) const {
    const float* const rows = &node.lo[0][0];
    const auto near = [&](int axis) {
      return multiply_add8(load8(rows + near_row_[axis]), reciprocal_[axis], near_[axis]);
    };
    const auto far = [&](int axis) {
      return multiply_add8(load8(rows + far_row_[axis]), reciprocal_[axis], far_[axis]);
    };
    const Lanes8 entry = max8(max8(near(0), near(1)), max8(near(2), tmin_));
    const Lanes8 exit = min8(min8(far(0), far(1)), min8(far(2), splat8(limit)));
    store8(t, entry);
    return less_equal8(entry, exit);
  }

 private:
  Lanes8 reciprocal_[3], near_[3], far_[3], tmin_;
  long near_row_[3], far_row_[3];
};

/// The same in binary64, whose range no ray and scene of binary32 leave.
class WideBoxes {
 public:
  using Distance = double;

  WideBoxes(const intersect::Ray& ray, const Reach& reach, int kz) : ray_(ray, reach, kz), tmin_(ray.tmin) {}

  unsigned test(const Node8& node, Distance limit, Distance* t) const {
    unsigned hit = 0;
    for (int lane = 0; lane < kWideLanes; ++lane) {
      double near = tmin_, far = limit;
      for (int axis = 0; axis < 3; ++axis) {
        const double lo = node.lo[axis][lane], hi = node.hi[axis][lane];
        near = std::max(near, (ray_.negative[axis] ? hi : lo) * ray_.reciprocal[axis] + ray_.near[axis]);
        far = std::min(far, (ray_.negative[axis] ? lo : hi) * ray_.reciprocal[axis] + ray_.far[axis]);
      }
      t[lane] = near - kSubnormalStep;
      if (t[lane] <= far) hit |= 1u << lane;
    }
    return hit;
  }

 private:
  /// What a t loses when it is rounded to a subnormal number, and to spare. FastBoxes' padding is far above it.
  static constexpr double kSubnormalStep = 0x1p-148;

  PaddedRay<double> ray_;
  double tmin_;
};

}  // namespace ctu::reference
