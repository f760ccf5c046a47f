#include "model/cull/packet/corner_rays.h"

namespace ctu::cull::packet {
namespace {

using numeric::cross;
using numeric::dot;

/// A corner ray begins at `origin` on the back plane and advances by 1 along the major axis in each unit of its
/// parameter. Components are forward and the two sides' axes: a mirror image of space for packets that go backward,
/// which changes the sign of all volumes alike.
struct CornerRay {
  IntervalVector origin, direction;
};

CornerRay corner_ray(const Frustum& frustum, bool high_first, bool high_second) {
  const auto place = [](const FrustumSide& s, bool high) { return Interval::point(high ? s.high : s.low); };
  const auto slope = [](const FrustumSide& s, bool high) { return Interval::point(high ? s.high_slope : s.low_slope); };
  const FrustumSide &u = frustum.side[0], &v = frustum.side[1];
  return {{Interval::point(frustum.back), place(u, high_first), place(v, high_second)},
          {Interval::point(1), slope(u, high_first), slope(v, high_second)}};
}

/// What the four corner rays agree on, as far as they have been asked.
struct Agreement {
  bool positive = true, negative = true;  ///< all are above zero, below zero
  bool not_negative = true, not_positive = true;

  void add(const Interval& x) {
    positive = positive && x.lo > 0;
    negative = negative && x.hi < 0;
    not_negative = not_negative && x.lo >= 0;
    not_positive = not_positive && x.hi <= 0;
  }
};

struct TriangleAgreement {
  Agreement side[3], rest[3];              ///< as in triangle_sides.h
  Agreement facing;                        ///< direction . normal
  Agreement height;                        ///< (vertex - origin) . normal
  Interval advance = Interval::nothing();  ///< where the corner rays cross the plane

  /// The plane is crossed by all four lines, in one sense.
  bool cuts() const { return facing.positive || facing.negative; }
  /// All rays begin on one side of the plane and do not go towards it.
  bool goes_away() const {
    return (height.negative && facing.not_negative) || (height.positive && facing.not_positive);
  }
  bool outside() const {
    for (int k = 0; k < 3; ++k) {
      if (facing.positive && (side[k].negative || rest[k].negative)) return true;
      if (facing.negative && (side[k].positive || rest[k].positive)) return true;
    }
    return false;
  }
  bool inside() const {
    if (facing.positive) return side[0].not_negative && side[1].not_negative && side[2].not_negative;
    return side[0].not_positive && side[1].not_positive && side[2].not_positive;
  }
};

/// One corner ray's part in it; `p` are the vertices, `normal` the triangle's.
void add_corner(const CornerRay& ray, const IntervalVector (&p)[3], const IntervalVector& normal,
                TriangleAgreement& agreement) {
  IntervalVector to[3];
  for (int i = 0; i < 3; ++i) to[i] = p[i] - ray.origin;
  const Interval facing = dot(ray.direction, normal), height = dot(to[0], normal);
  agreement.facing.add(facing);
  agreement.height.add(height);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    agreement.side[k].add(dot(ray.direction, cross(to[i], to[j])));
    // side[i] + side[j]: on which side of the parallel to the edge through the opposite vertex.
    agreement.rest[k].add(dot(ray.direction, cross(to[k], p[i] - p[j])));
  }
  if (!facing.holds(0)) agreement.advance = unite(agreement.advance, height / facing);
}

/// The part of `where` in which start + slope x lies at or below zero: -start / slope parts it.
Interval not_above_zero(const Interval& where, const Interval& start, float slope) {
  if (slope == 0) return start.lo <= 0 ? where : Interval::nothing();
  const Interval zero = -start / Interval::point(slope);
  return slope > 0 ? overlap(where, {where.lo, zero.hi}) : overlap(where, {zero.lo, where.hi});
}

}  // namespace

CornerRays::CornerRays(const Lines& lines)
    : reference_(lines.reference), axis_(lines.axis), backward_(lines.backward), frustum_(make_frustum(lines)) {}

Interval CornerRays::advance_of(const IntervalVector& place) const {
  return (backward_ ? -place[axis_] : place[axis_]) - Interval::point(frustum_->back);
}

Answer CornerRays::test(const Box& box, const Reach& reach) const {
  if (!frustum_) return Answer::Undecided;
  const IntervalVector lower = numeric::difference(box.lo, reference_), upper = numeric::difference(box.hi, reference_);
  const Interval ahead = advance_of(unite(lower, upper));
  const float front = numeric::min(frustum_->front, reach.forward);
  if (!(front >= frustum_->back)) return Answer::AllMiss;
  Interval where = overlap(ahead, {0, (Interval::point(front) - Interval::point(frustum_->back)).hi});
  for (const FrustumSide& side : frustum_->side) {
    const Interval to_lower = Interval::point(side.high) - lower[side.axis];  // the high side stays above it where >= 0
    const Interval to_upper = Interval::point(side.low) - upper[side.axis];
    if (where.empty()) break;
    where = not_above_zero(where, -to_lower, -side.high_slope);
    if (where.empty()) break;
    where = not_above_zero(where, to_upper, side.low_slope);
  }
  if (where.empty()) return Answer::AllMiss;
  return all_meet(lower, upper) ? Answer::AllHit : Answer::Undecided;
}

/// At the first place in the box at which all rays have begun, the rectangle between the corner rays lies in the box,
/// and no ray has ended.
bool CornerRays::all_meet(const IntervalVector& lower, const IntervalVector& upper) const {
  const Interval face_a = advance_of(lower), face_b = advance_of(upper);
  const Interval near = backward_ ? face_b : face_a, far = backward_ ? face_a : face_b;
  const Interval back = Interval::point(frustum_->back);
  const float at = numeric::max(near.hi, (Interval::point(frustum_->all_begun) - back).hi);
  const float ends = (Interval::point(frustum_->first_end) - back).lo;
  if (!(at <= far.lo && at <= ends)) return false;
  for (const FrustumSide& side : frustum_->side) {
    const Interval low = Interval::point(side.low) + Interval::point(side.low_slope) * Interval::point(at);
    const Interval high = Interval::point(side.high) + Interval::point(side.high_slope) * Interval::point(at);
    if (!(low.lo >= lower[side.axis].hi && high.hi <= upper[side.axis].lo)) return false;
  }
  return true;
}

Answer CornerRays::test(const Triangle& triangle, const Reach& reach) const {
  if (!frustum_) return Answer::Undecided;
  IntervalVector p[3];
  for (int i = 0; i < 3; ++i) {
    const IntervalVector place = numeric::difference(triangle.vertex[i], reference_);
    p[i] = {backward_ ? -place[axis_] : place[axis_], place[frustum_->side[0].axis], place[frustum_->side[1].axis]};
  }
  const IntervalVector normal = cross(p[1] - p[0], p[2] - p[0]);
  TriangleAgreement agreement;
  for (const bool high_first : {false, true})
    for (const bool high_second : {false, true})
      add_corner(corner_ray(*frustum_, high_first, high_second), p, normal, agreement);
  if (agreement.goes_away()) return Answer::AllMiss;
  if (!agreement.cuts()) return Answer::Undecided;
  if (agreement.outside()) return Answer::AllMiss;
  const Interval back = Interval::point(frustum_->back);
  const Interval between = {(Interval::point(frustum_->all_begun) - back).hi,
                            (Interval::point(frustum_->first_end) - back).lo};
  const Interval in_reach = {0, (Interval::point(numeric::min(frustum_->front, reach.forward)) - back).hi};
  if (overlap(agreement.advance, in_reach).empty()) return Answer::AllMiss;
  return agreement.inside() && within(agreement.advance, between) ? Answer::AllHit : Answer::Undecided;
}

}  // namespace ctu::cull::packet
