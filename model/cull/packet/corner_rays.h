// Four virtual rays along the edges of a packet's frustum. At any one place along the major axis, every ray of the
// packet lies in the rectangle between them.
//
// Triangles: where all four rise towards the triangle's plane from the same side of it, the frustum cuts the plane in
// the quadrilateral between their four points, and all rays cross it there; so what all four points lie outside of, all
// rays miss, and inside of, hit. Where some of the points lie behind the rays (t < 0), the cut is not between them
// (Fig. 6): then nothing is concluded, unless all rays go away from the plane.
//
// Boxes: across the major axis the frustum and the box are both rectangles, so they meet if and only if there is a
// place along it at which these overlap; the corner rays say from where to where they do on either axis.
// Source: section 5 of the packet culling paper; the box test is ours.
#pragma once

#include <optional>

#include "model/cull/packet/answer.h"
#include "model/cull/packet/frustum.h"

namespace ctu::cull::packet {

class CornerRays {
 public:
  /// `lines` as of Scale::MajorAxis. Without a frustum every answer is Undecided.
  explicit CornerRays(const Lines& lines);

  Answer test(const Box& box, const Reach& reach = {}) const;
  Answer test(const Triangle& triangle, const Reach& reach = {}) const;

 private:
  /// How far from the back plane something is, as a range.
  Interval advance_of(const IntervalVector& place) const;
  bool all_meet(const IntervalVector& lower, const IntervalVector& upper) const;

  Vec3 reference_;
  int axis_;
  bool backward_;
  std::optional<Frustum> frustum_;
};

}  // namespace ctu::cull::packet
