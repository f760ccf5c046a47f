// Interval arithmetic on a whole packet: the packet's quantities as intervals, put through the tests of a single ray.
// Source: section 3 of the packet culling paper.
#pragma once

#include "model/cull/packet/answer.h"
#include "model/cull/packet/lines.h"

namespace ctu::cull::packet {

class IntervalBounds {
 public:
  explicit IntervalBounds(const Lines& lines);

  /// Equation 1, T_x = (B_x - O_x) / V_x, cut with the tightened form B_x / V_x - R of the same section, on axes that
  /// all rays move along in one direction; then, on all axes, whether O_x + T V_x comes to B_x at all.
  Answer test(const Box& box, const Reach& reach = {}) const;

  /// The sides of triangle_sides.h, then the t of the plane.
  Answer test(const Triangle& triangle, const Reach& reach = {}) const;

  /// Section 3.2: the discriminant, in the paper's form and as r^2 V.V - |OC x V|^2, which cancels less; then T_s.
  Answer test(const Sphere& sphere, const Reach& reach = {}) const;

 private:
  /// Where every ray still is and where some ray may be, in t'.
  Interval times(const Reach& reach) const { return {begins_, numeric::min(ends_, reach.time)}; }
  Interval common_times() const { return {all_begun_, all_last_}; }
  /// When the rays are at a coordinate of an axis that all move along in one direction.
  Interval time_at(int axis, const Interval& coordinate) const;
  bool all_meet(const IntervalVector& lower, const IntervalVector& upper) const;

  Vec3 reference_;
  bool shared_origin_;  ///< then origins and moments are zero, and terms with them are left out
  bool one_sign_[3];    ///< all directions have the same sign on the axis, and none is zero
  IntervalVector origin_, direction_;
  IntervalVector reciprocal_;   ///< 1 / direction
  IntervalVector ratio_;        ///< origin / direction, ray by ray
  IntervalVector moment_;       ///< origin x direction, ray by ray
  float begins_, ends_;         ///< the first begin and the last end
  float all_begun_, all_last_;  ///< the last begin and the first end
};

}  // namespace ctu::cull::packet
