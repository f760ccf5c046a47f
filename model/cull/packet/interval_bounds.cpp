#include "model/cull/packet/interval_bounds.h"

#include <cmath>

#include "model/cull/packet/triangle_sides.h"

namespace ctu::cull::packet {

using numeric::difference;
using numeric::dot;
using numeric::overlap;

IntervalBounds::IntervalBounds(const Lines& lines)
    : reference_(lines.reference),
      shared_origin_(lines.shared_origin),
      origin_(IntervalVector::nothing()),
      direction_(IntervalVector::nothing()),
      ratio_(IntervalVector::nothing()),
      moment_(IntervalVector::nothing()) {
  const Line& front = lines.lines.front();
  begins_ = front.first.lo, all_begun_ = front.first.hi;
  ends_ = front.last.hi, all_last_ = front.last.lo;
  for (const Line& line : lines.lines) {
    origin_ = unite(origin_, line.origin);
    direction_ = unite(direction_, line.direction);
    if (!shared_origin_) moment_ = unite(moment_, cross(line.origin, line.direction));
    begins_ = numeric::min(begins_, line.first.lo);
    all_begun_ = numeric::max(all_begun_, line.first.hi);
    ends_ = numeric::max(ends_, line.last.hi);
    all_last_ = numeric::min(all_last_, line.last.lo);
  }
  for (int axis = 0; axis < 3; ++axis) {
    one_sign_[axis] = !direction_[axis].holds(0);
    if (!one_sign_[axis]) continue;
    reciprocal_[axis] = numeric::reciprocal(direction_[axis]);
    if (shared_origin_) continue;
    for (const Line& line : lines.lines) ratio_[axis] = unite(ratio_[axis], line.origin[axis] / line.direction[axis]);
  }
}

Interval IntervalBounds::time_at(int axis, const Interval& coordinate) const {
  if (shared_origin_) return coordinate * reciprocal_[axis];
  return overlap((coordinate - origin_[axis]) * reciprocal_[axis], coordinate * reciprocal_[axis] - ratio_[axis]);
}

Answer IntervalBounds::test(const Box& box, const Reach& reach) const {
  const IntervalVector lower = difference(box.lo, reference_), upper = difference(box.hi, reference_);
  const auto extent = [&](int axis) { return Interval{lower[axis].lo, upper[axis].hi}; };
  Interval time = times(reach);
  for (int axis = 0; axis < 3; ++axis) {
    if (one_sign_[axis]) time = overlap(time, time_at(axis, extent(axis)));
    if (time.empty()) return Answer::AllMiss;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Interval place = shared_origin_ ? direction_[axis] * time : origin_[axis] + direction_[axis] * time;
    if (overlap(place, extent(axis)).empty()) return Answer::AllMiss;
  }
  return all_meet(lower, upper) ? Answer::AllHit : Answer::Undecided;
}

/// From the last entry to the first exit, all rays are within the slabs of axes that they all move along in one
/// direction; at the first such moment they must be within the others as well.
bool IntervalBounds::all_meet(const IntervalVector& lower, const IntervalVector& upper) const {
  Interval inside = common_times();
  for (int axis = 0; axis < 3; ++axis) {
    if (!one_sign_[axis]) continue;
    const bool up = direction_[axis].lo > 0;
    const float entry = time_at(axis, up ? lower[axis] : upper[axis]).hi;
    const float exit = time_at(axis, up ? upper[axis] : lower[axis]).lo;
    inside = overlap(inside, {entry, exit});
  }
  if (inside.empty() || !std::isfinite(inside.lo)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (one_sign_[axis]) continue;
    const Interval place = origin_[axis] + direction_[axis] * Interval::point(inside.lo);
    if (!within(place, {lower[axis].hi, upper[axis].lo})) return false;
  }
  return true;
}

Answer IntervalBounds::test(const Triangle& triangle, const Reach& reach) const {
  const TriangleSides sides(triangle, reference_);
  SideRanges ranges;
  ranges.facing = dot(direction_, sides.normal);
  for (int k = 0; k < 3; ++k) {
    const IntervalVector& edge = sides.by_moment[k];
    const IntervalVector others = sides.by_direction[(k + 1) % 3] + sides.by_direction[(k + 2) % 3];
    ranges.side[k] = dot(direction_, sides.by_direction[k]);
    ranges.rest[k] = dot(direction_, others);
    if (shared_origin_) continue;
    const Interval by_moment = dot(moment_, edge);
    ranges.side[k] = ranges.side[k] + by_moment;
    ranges.rest[k] = ranges.rest[k] - by_moment;
  }
  if (ranges.outside()) return Answer::AllMiss;
  if (ranges.facing.holds(0)) return Answer::Undecided;
  const IntervalVector to_plane = shared_origin_ ? sides.vertex : sides.vertex - origin_;
  const Interval time = dot(sides.normal, to_plane) / ranges.facing;
  if (overlap(time, times(reach)).empty()) return Answer::AllMiss;
  return ranges.inside() && within(time, common_times()) ? Answer::AllHit : Answer::Undecided;
}

Answer IntervalBounds::test(const Sphere& sphere, const Reach& reach) const {
  const IntervalVector centre = difference(sphere.centre, reference_);
  const IntervalVector from_centre = shared_origin_ ? -centre : origin_ - centre;
  const Interval radius = Interval::point(std::fabs(sphere.radius)), radius_squared = square(radius);
  const Interval a = squared_length(direction_), b = dot(direction_, from_centre);
  const IntervalVector across_centre = cross(centre, direction_);
  const IntervalVector across = shared_origin_ ? -across_centre : moment_ - across_centre;
  const Interval papers = square(b) - a * (squared_length(from_centre) - radius_squared);
  const Interval discriminant = overlap(papers, radius_squared * a - squared_length(across));
  if (discriminant.hi < 0) return Answer::AllMiss;
  if (a.lo <= 0) return Answer::Undecided;
  const Interval root = numeric::root(discriminant);
  const Interval early = (-b - root) / a, late = (root - b) / a;
  if (overlap(unite(early, late), times(reach)).empty()) return Answer::AllMiss;
  const bool on_surface = within(early, common_times()) || within(late, common_times());
  return discriminant.lo >= 0 && on_surface ? Answer::AllHit : Answer::Undecided;
}

}  // namespace ctu::cull::packet
