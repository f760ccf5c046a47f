// Affine arithmetic on a whole packet: the paper's future work (section 6), against the bloat of intervals.
//
// Symbols 0, 1, 2 say where in the packet a ray's direction lies, one for each axis; 3, 4, 5 where its origin lies
// beside what the direction already tells of it. So rays that spread from a point, or meet in one, or start all over a
// surface keep what relates them, and products of origins and directions cancel as they do for a single ray. With a
// major axis a line's origin is where it passes the packet's back plane: four numbers say all of a line.
#pragma once

#include "model/cull/packet/answer.h"
#include "model/cull/packet/lines.h"
#include "model/numeric/affine.h"

namespace ctu::cull::packet {

class AffineBounds {
 public:
  /// `lines` as of Scale::MajorAxis.
  explicit AffineBounds(const Lines& lines);

  /// Whether all rays stay beyond one face while they are within the box's reach along other axes, or pass an edge of
  /// the box on the same side, as seen along an axis.
  Answer test(const Box& box, const Reach& reach = {}) const;
  /// The sides of triangle_sides.h, and the height over its plane where rays begin and end.
  Answer test(const Triangle& triangle, const Reach& reach = {}) const;
  /// The discriminant as r^2 V.V - |OC x V|^2, and whether rays begin beyond the sphere or end before it.
  Answer test(const Sphere& sphere, const Reach& reach = {}) const;

  /// Where the lines' moments, origin x direction, may lie.
  IntervalVector moments() const { return {moment_[0].range(), moment_[1].range(), moment_[2].range()}; }

 private:
  using Form = numeric::Affine<6>;

  /// Where some ray may be, and all rays are: distance from the back plane, or t' without a major axis.
  struct Extent {
    float begin, end, all_begun, first_end;
  };

  void relate(const Lines& lines, const std::vector<IntervalVector>& origins, int axis);
  float end_within(const Reach& reach) const;
  Interval advance_of(const IntervalVector& place) const;
  Form place_at(int axis, float advance) const { return origin_[axis] + direction_[axis] * advance; }
  Interval advance_within(int axis, const Interval& extent) const;
  bool stays_beyond(int axis, const Interval& extent, const Interval& advance) const;
  bool passes_beside(int axis, const IntervalVector& lower, const IntervalVector& upper) const;
  bool all_meet(const IntervalVector& lower, const IntervalVector& upper) const;

  Vec3 reference_;
  int axis_;
  bool backward_;
  float back_ = 0;  ///< forward coordinate that advance counts from
  Extent extent_{};
  Form origin_[3], direction_[3], moment_[3];
};

}  // namespace ctu::cull::packet
