#include "model/cull/packet/affine_bounds.h"

#include <cmath>

#include "model/cull/packet/triangle_sides.h"

namespace ctu::cull::packet {
namespace {

using numeric::difference;
using numeric::overlap;

double middle(const Interval& x) { return 0.5 * (static_cast<double>(x.lo) + x.hi); }

/// How much of an origin's coordinate follows its symbol: least squares. Any number would do.
float slope_of(const std::vector<Interval>& symbol, const std::vector<IntervalVector>& origins, int axis) {
  const auto count = static_cast<double>(symbol.size());
  double mean_symbol = 0, mean_origin = 0, both = 0, spread = 0;
  for (std::size_t i = 0; i < symbol.size(); ++i) {
    mean_symbol += middle(symbol[i]) / count;
    mean_origin += middle(origins[i][axis]) / count;
  }
  for (std::size_t i = 0; i < symbol.size(); ++i) {
    const double e = middle(symbol[i]) - mean_symbol;
    both += e * (middle(origins[i][axis]) - mean_origin);
    spread += e * e;
  }
  const auto slope = static_cast<float>(both / spread);
  return std::isfinite(slope) ? slope : 0;
}

template <class Form>
Form dot(const Form (&a)[3], const IntervalVector& b) {
  return a[0] * b.x + a[1] * b.y + a[2] * b.z;
}
template <class Form>
Form squared_length(const Form (&a)[3]) {
  return square(a[0]) + square(a[1]) + square(a[2]);
}

}  // namespace

AffineBounds::AffineBounds(const Lines& lines)
    : reference_(lines.reference), axis_(lines.axis), backward_(lines.backward) {
  Interval begins = Interval::nothing();
  float first_end = INFINITY, end = -INFINITY;
  for (const Line& line : lines.lines) {
    const Interval from = axis_ < 0 ? Interval{} : lines.forward(line.origin);
    begins = unite(begins, from + line.first);
    first_end = numeric::min(first_end, (from + Interval::point(line.last.lo)).lo);
    end = numeric::max(end, (from + Interval::point(line.last.hi)).hi);
  }
  if (!std::isfinite(begins.lo)) {  // beyond binary32: nothing is known of where rays begin and end
    axis_ = -1;
    extent_ = {-INFINITY, INFINITY, INFINITY, -INFINITY};
  }
  const bool by_plane = axis_ >= 0;
  back_ = by_plane ? begins.lo : 0;
  const Interval back = Interval::point(back_);
  const auto after_back = [&](float at) { return Interval::point(at) - back; };
  if (std::isfinite(begins.lo))
    extent_ = {after_back(begins.lo).lo, after_back(end).hi, after_back(begins.hi).hi, after_back(first_end).lo};

  std::vector<IntervalVector> origins;
  for (const Line& line : lines.lines) {
    IntervalVector origin = line.origin;
    if (by_plane) {
      const Interval advance = lines.forward(line.origin) + line.first - back;
      origin = origin + line.direction * line.first - line.direction * advance;
      origin[axis_] = backward_ ? -back : back;
    }
    origins.push_back(origin);
  }
  for (int axis = 0; axis < 3; ++axis) relate(lines, origins, axis);
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    moment_[axis] = origin_[next] * direction_[last] - origin_[last] * direction_[next];
  }
}

/// Gives the axis its symbols: direction and origin as forms, such that every ray is one choice of them.
void AffineBounds::relate(const Lines& lines, const std::vector<IntervalVector>& origins, int axis) {
  const auto along = static_cast<std::size_t>(axis), beside = along + 3;
  Interval directions = Interval::nothing();
  for (const Line& line : lines.lines) directions = unite(directions, line.direction[axis]);
  const numeric::Middle direction = numeric::middle_of(directions);
  direction_[axis] = Form::point(direction.centre);
  direction_[axis].part[along] = direction.radius;

  float slope = 0;
  std::vector<Interval> symbol;
  if (direction.radius > 0 && std::isfinite(direction.radius)) {
    for (const Line& line : lines.lines)
      symbol.push_back((line.direction[axis] - Interval::point(direction.centre)) / Interval::point(direction.radius));
    slope = slope_of(symbol, origins, axis);
  }
  Interval rest = Interval::nothing();
  for (std::size_t i = 0; i < origins.size(); ++i)
    rest = unite(rest, slope == 0 ? origins[i][axis] : origins[i][axis] - symbol[i] * Interval::point(slope));
  const numeric::Middle origin = numeric::middle_of(rest);
  origin_[axis] = Form::point(origin.centre);
  origin_[axis].part[along] = slope;
  origin_[axis].part[beside] = origin.radius;
}

float AffineBounds::end_within(const Reach& reach) const {
  const float limit = axis_ < 0 ? reach.time : (Interval::point(reach.forward) - Interval::point(back_)).hi;
  return numeric::min(extent_.end, limit);
}

Interval AffineBounds::advance_of(const IntervalVector& place) const {
  return (backward_ ? -place[axis_] : place[axis_]) - Interval::point(back_);
}

/// When rays may be between two faces: of use where all go the same way along the axis.
Interval AffineBounds::advance_within(int axis, const Interval& extent) const {
  return (extent - origin_[axis].range()) / direction_[axis].range();
}

/// Beyond a face at both ends of a stretch, a ray is beyond it all the way.
bool AffineBounds::stays_beyond(int axis, const Interval& extent, const Interval& advance) const {
  if (!std::isfinite(advance.lo)) return false;
  const Interval at_begin = place_at(axis, advance.lo).range();
  const bool above = at_begin.lo > extent.hi, below = at_begin.hi < extent.lo;
  if (!above && !below) return false;
  if (std::isinf(advance.hi)) {
    const Interval direction = direction_[axis].range();
    return above ? direction.lo >= 0 : direction.hi <= 0;
  }
  const Interval at_end = place_at(axis, advance.hi).range();
  return above ? at_end.lo > extent.hi : at_end.hi < extent.lo;
}

/// Seen along `axis`, the box is a rectangle; the ray passes all its corners (x, y) on one side where
/// (o_x - x) d_y - (o_y - y) d_x = m - x d_y + y d_x has one sign.
bool AffineBounds::passes_beside(int axis, const IntervalVector& lower, const IntervalVector& upper) const {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  bool left = true, right = true;
  for (int corner = 0; corner < 4 && (left || right); ++corner) {
    const IntervalVector &at_x = (corner & 1) != 0 ? upper : lower, &at_y = (corner & 2) != 0 ? upper : lower;
    const Interval side = (moment_[axis] - direction_[y] * at_x[x] + direction_[x] * at_y[y]).range();
    left = left && side.positive();
    right = right && side.negative();
  }
  return left || right;
}

Answer AffineBounds::test(const Box& box, const Reach& reach) const {
  const IntervalVector lower = difference(box.lo, reference_), upper = difference(box.hi, reference_);
  Interval advance{extent_.begin, end_within(reach)};
  const IntervalVector extent = unite(lower, upper);
  for (int axis = 0; axis < 3; ++axis) {
    advance = overlap(advance, axis == axis_ ? advance_of(extent) : advance_within(axis, extent[axis]));
    if (advance.empty()) return Answer::AllMiss;
  }
  for (int axis = 0; axis < 3; ++axis)
    if (axis != axis_ && stays_beyond(axis, extent[axis], advance)) return Answer::AllMiss;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis_ >= 0 && axis != axis_) continue;  // its edges are those of the faces that were just asked
    if (passes_beside(axis, lower, upper)) return Answer::AllMiss;
  }
  return all_meet(lower, upper) ? Answer::AllHit : Answer::Undecided;
}

/// All rays are in the box at the first moment at which all have begun and are within its reach along the axis.
bool AffineBounds::all_meet(const IntervalVector& lower, const IntervalVector& upper) const {
  float at = extent_.all_begun;
  if (axis_ >= 0) {
    const Interval near = advance_of(backward_ ? upper : lower), far = advance_of(backward_ ? lower : upper);
    at = numeric::max(at, near.hi);
    if (!(at <= far.lo)) return false;
  }
  if (!(at <= extent_.first_end) || !std::isfinite(at)) return false;
  for (int axis = 0; axis < 3; ++axis)
    if (axis != axis_ && !within(place_at(axis, at).range(), {lower[axis].hi, upper[axis].lo})) return false;
  return true;
}

Answer AffineBounds::test(const Triangle& triangle, const Reach& reach) const {
  const TriangleSides sides(triangle, reference_);
  const Form facing = dot(direction_, sides.normal);
  SideRanges ranges;
  ranges.facing = facing.range();
  for (int k = 0; k < 3; ++k) {
    const Form side = dot(direction_, sides.by_direction[k]) + dot(moment_, sides.by_moment[k]);
    ranges.side[k] = side.range();
    ranges.rest[k] = (facing - side).range();
  }
  if (ranges.outside()) return Answer::AllMiss;
  if (ranges.facing.holds(0)) return Answer::Undecided;

  // How far the plane still lies ahead at some moment, in the sense of the normal; towards the normal is ahead.
  const Form height = -dot(origin_, sides.normal) + numeric::dot(sides.normal, sides.vertex);
  const auto ahead_at = [&](float advance) {
    const Interval ahead = (height - facing * advance).range();
    return ranges.facing.positive() ? ahead : -ahead;
  };
  const float end = end_within(reach);
  if (std::isfinite(extent_.begin) && ahead_at(extent_.begin).negative()) return Answer::AllMiss;
  if (std::isfinite(end) && ahead_at(end).positive()) return Answer::AllMiss;
  const bool begun = std::isfinite(extent_.all_begun) && ahead_at(extent_.all_begun).lo >= 0;
  const bool reached = std::isinf(extent_.first_end) ? extent_.first_end > 0 : ahead_at(extent_.first_end).hi <= 0;
  return begun && reached && ranges.inside() ? Answer::AllHit : Answer::Undecided;
}

Answer AffineBounds::test(const Sphere& sphere, const Reach& reach) const {
  const IntervalVector centre = difference(sphere.centre, reference_);
  const Interval radius_squared = square(Interval::point(std::fabs(sphere.radius)));
  Form across[3];  // (origin - centre) x direction
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    across[axis] = moment_[axis] - direction_[last] * centre[next] + direction_[next] * centre[last];
  }
  const Form discriminant = squared_length(direction_) * radius_squared - squared_length(across);
  if (discriminant.range().negative()) return Answer::AllMiss;

  struct Moment {
    Interval outside;  ///< squared distance from the centre less the squared radius
    Interval leaving;  ///< how the former changes
  };
  const auto at = [&](float advance) {
    Form from_centre[3];
    for (int axis = 0; axis < 3; ++axis) from_centre[axis] = place_at(axis, advance) - centre[axis];
    const Form leaving =
        from_centre[0] * direction_[0] + from_centre[1] * direction_[1] + from_centre[2] * direction_[2];
    return Moment{(squared_length(from_centre) - radius_squared).range(), leaving.range()};
  };
  if (std::isfinite(extent_.begin)) {
    const Moment begin = at(extent_.begin);
    if (begin.outside.positive() && begin.leaving.positive()) return Answer::AllMiss;
  }
  const float end = end_within(reach);
  if (std::isfinite(end)) {
    const Moment last = at(end);
    if (last.outside.positive() && last.leaving.negative()) return Answer::AllMiss;
  }
  // All rays are outside when all have begun, and inside at a later moment: about where the middle ray is nearest.
  if (!std::isfinite(extent_.all_begun) || at(extent_.all_begun).outside.lo < 0) return Answer::Undecided;
  double towards = 0, length = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = direction_[axis].centre;
    towards += d * (middle(centre[axis]) - origin_[axis].centre);
    length += d * d;
  }
  const auto nearest = static_cast<float>(towards / length);
  if (!(extent_.all_begun <= nearest && nearest <= extent_.first_end && std::isfinite(nearest)))
    return Answer::Undecided;
  return at(nearest).outside.hi <= 0 ? Answer::AllHit : Answer::Undecided;
}

}  // namespace ctu::cull::packet
