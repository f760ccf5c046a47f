// Ray-box culling: a box around the part of a ray that lies in a leaf, held against the box of each primitive there
// before the primitive itself is tested. Sources: Snyder and Barr 1987; Woo 1992 for the update after a hit; Nah, Park,
// Kang and Han, "Ray-Box Culling for Tree Structures", Algorithms 1 to 4.
//
// Algorithms 2 and 4 move each face outward by a fixed 0.0001, which loses hits where coordinates are large, because
// the rounding of o + t d is larger there, and culls less than it could where they are small. Here each face is rounded
// outward instead: for t_a <= t <= t_b and d >= 0, down(o + down(t_a d)) <= o + t d <= up(o + up(t_b d)) in exact
// arithmetic, and mirrored for d < 0. The interval that encloses the ray's stay in the leaf gives a box that holds
// every point of that stay; what meets the ray there has such a point in its own box, so the two overlap.
#pragma once

#include <cstdint>

#include "model/accel/primitive_box.h"
#include "model/intersect/ray.h"
#include "model/numeric/round.h"

namespace ctu::cull {

class RayBox {
 public:
  /// Around the ray's points with t in [tmin, tmax], for a valid ray; infinite ends are allowed (Algorithm 2).
  RayBox(const intersect::Ray& ray, float tmin, float tmax) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool backwards = ray.direction[axis] < 0;
      box_.lower[axis] = bound<numeric::Round::Down>(ray, axis, backwards ? tmax : tmin);
      box_.upper[axis] = bound<numeric::Round::Up>(ray, axis, backwards ? tmin : tmax);
    }
  }

  /// Lets the ray end at `tmax`, at or before where it ended: three faces move (Algorithm 4).
  void end_at(const intersect::Ray& ray, float tmax) {
    for (int axis = 0; axis < 3; ++axis) {
      if (ray.direction[axis] < 0)
        box_.lower[axis] = bound<numeric::Round::Down>(ray, axis, tmax);
      else
        box_.upper[axis] = bound<numeric::Round::Up>(ray, axis, tmax);
    }
  }

  /// Whether the closed boxes have a point in common (Algorithm 3).
  bool overlaps(const accel::PrimitiveBox& other) const {
    for (int axis = 0; axis < 3; ++axis)
      if (box_.lower[axis] > other.upper[axis] || box_.upper[axis] < other.lower[axis]) return false;
    return true;
  }

  const accel::PrimitiveBox& box() const { return box_; }

 private:
  /// o + t d rounded in one direction; an infinite t on an axis along which the ray does not move says nothing.
  template <numeric::Round M>
  static float bound(const intersect::Ray& ray, int axis, float t) {
    const float d = ray.direction[axis];
    return d == 0 ? ray.origin[axis] : numeric::add<M>(ray.origin[axis], numeric::mul<M>(t, d));
  }

  accel::PrimitiveBox box_;
};

/// No culling: every primitive of a leaf is tested.
struct NoRayBox {};

/// The paper's N_PI, N_AC and N_AU, and the overlap tests between them.
struct RayBoxCounts {
  std::uint64_t primitive_tests = 0;  ///< N_PI
  std::uint64_t box_tests = 0;        ///< overlap tests
  std::uint64_t created = 0;          ///< N_AC: boxes made around the ray
  std::uint64_t updated = 0;          ///< N_AU: ... and cut at a hit

  RayBoxCounts& operator+=(const RayBoxCounts& o) {
    primitive_tests += o.primitive_tests;
    box_tests += o.box_tests;
    created += o.created;
    updated += o.updated;
    return *this;
  }
};

}  // namespace ctu::cull
