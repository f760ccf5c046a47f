// On which side of a triangle's edges lines pass, as numbers that are linear in a line's Pluecker coordinates: its
// direction d and its moment m = o x d.
//
//   side[k] = d . ((p_i - o) x (p_j - o)) = d . (p_i x p_j) + m . (p_j - p_i)      for (i, j, k) = (1, 2, 0), ...
//   facing  = d . n = side[0] + side[1] + side[2]                                  n the triangle's normal
//
// A line that meets the closed triangle in (1-a-b) p_0 + a p_1 + b p_2 has side[k] = (its k-th weight) facing: so where
// two sides have opposite signs, or one the sign opposite to facing, or exceeds it, it misses, whatever the shape.
// This is the barycentric test of section 3.3 of the packet culling paper without its division.
#pragma once

#include "model/cull/packet/answer.h"
#include "model/numeric/interval_vector.h"

namespace ctu::cull::packet {

using numeric::Interval;
using numeric::IntervalVector;

/// The factors of d and m, enclosed; points are relative to the packet's reference.
struct TriangleSides {
  IntervalVector by_direction[3], by_moment[3];
  IntervalVector normal, vertex;  ///< `vertex`: one of the three

  TriangleSides(const Triangle& triangle, const Vec3& reference) {
    IntervalVector p[3];
    for (int i = 0; i < 3; ++i) p[i] = numeric::difference(triangle.vertex[i], reference);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      by_direction[k] = numeric::cross(p[i], p[j]);
      by_moment[k] = numeric::difference(triangle.vertex[j], triangle.vertex[i]);
    }
    normal = numeric::cross(by_moment[1], by_moment[2]);
    vertex = p[0];
  }
};

/// What a set of lines makes of a triangle: where its sides, the rest that the sides leave of `facing`, and facing
/// itself may lie.
struct SideRanges {
  Interval side[3], rest[3], facing;

  /// Every line passes outside of the same edge, or beyond the vertex opposite to it.
  bool outside() const {
    bool positive = facing.positive(), negative = facing.negative();
    for (int k = 0; k < 3; ++k) {
      positive = positive || side[k].positive();
      negative = negative || side[k].negative();
      if ((facing.positive() && rest[k].negative()) || (facing.negative() && rest[k].positive())) return true;
    }
    return positive && negative;
  }

  /// Every line crosses the plane inside of all edges.
  bool inside() const {
    if (facing.positive()) return side[0].lo >= 0 && side[1].lo >= 0 && side[2].lo >= 0;
    return facing.negative() && side[0].hi <= 0 && side[1].hi <= 0 && side[2].hi <= 0;
  }
};

}  // namespace ctu::cull::packet
