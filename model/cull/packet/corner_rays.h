// Four virtual rays along the edges of a packet's frustum. At any one place along the major axis, every ray of the
// packet lies in the rectangle between them.
//
// Triangles: where the four lines cross the triangle's plane in one sense, the frustum cuts the plane within the
// quadrilateral between their four points. For its cut's corners are those points that lie ahead of the back plane, and
// points of the back rectangle's edges. Two neighbouring lines and the edge between their begins lie in one plane, in
// which they spread, so a cut that passes from one line to the other ahead of it through the edge comes to the other
// line behind it: the point on the edge lies between the two on the lines. So what all four points lie outside of, all
// rays miss, and inside of, hit if they get there. Where the senses differ, rays between two corner rays do not pass
// between their points (Fig. 6, t < 0): then nothing is concluded, unless all rays go away from the plane.
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
