#include "model/cull/packet/bounding_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ctu::cull::packet {
namespace {

/// All points of a line, from its begin to its end.
IntervalVector course(const Line& line) { return line.origin + line.direction * Interval{line.first.lo, line.last.hi}; }

}  // namespace

BoundingPlanes::BoundingPlanes(const Lines& lines)
    : reference_(lines.reference),
      axis_(lines.axis),
      backward_(lines.backward),
      frustum_(make_frustum(lines)),
      around_(IntervalVector::nothing()) {
  for (const Line& line : lines.lines) around_ = unite(around_, course(line));
}

BoundingPlanes::Beyond BoundingPlanes::beyond(const FrustumSide& side, const IntervalVector& place) const {
  const Interval advance = (backward_ ? -place[axis_] : place[axis_]) - Interval::point(frustum_->back);
  const Interval across = place[side.axis];
  return {advance * Interval::point(side.low_slope) - (across - Interval::point(side.low)),
          across - Interval::point(side.high) - advance * Interval::point(side.high_slope)};
}

/// Whether all points lie beyond one plane.
bool BoundingPlanes::all_beyond(std::span<const IntervalVector> points, const Reach& reach) const {
  const auto all = [&](auto&& is_beyond) { return std::all_of(points.begin(), points.end(), is_beyond); };
  for (int axis = 0; axis < 3; ++axis) {
    if (all([&](const IntervalVector& p) { return p[axis].lo > around_[axis].hi; })) return true;
    if (all([&](const IntervalVector& p) { return p[axis].hi < around_[axis].lo; })) return true;
  }
  if (!frustum_) return false;
  if (all([&](const IntervalVector& p) { return (backward_ ? -p[axis_] : p[axis_]).lo > reach.forward; })) return true;
  for (const FrustumSide& side : frustum_->side) {
    if (all([&](const IntervalVector& p) { return beyond(side, p).low.positive(); })) return true;
    if (all([&](const IntervalVector& p) { return beyond(side, p).high.positive(); })) return true;
  }
  return false;
}

/// The vertex of a box that lies furthest in, of each plane: what interval arithmetic finds by itself (section 4.2.1).
Answer BoundingPlanes::test(const Box& box, const Reach& reach) const {
  const IntervalVector lower = numeric::difference(box.lo, reference_), upper = numeric::difference(box.hi, reference_);
  const IntervalVector extent = unite(lower, upper);
  return all_beyond({&extent, 1}, reach) ? Answer::AllMiss : Answer::Undecided;
}

Answer BoundingPlanes::test_points(std::span<const Vec3> points, const Reach& reach) const {
  std::array<IntervalVector, 6> places;
  for (std::size_t i = 0; i < points.size(); ++i) places[i] = numeric::difference(points[i], reference_);
  return all_beyond({places.data(), points.size()}, reach) ? Answer::AllMiss : Answer::Undecided;
}

Answer BoundingPlanes::test(const Triangle& triangle, const Reach& reach) const {
  return test_points(triangle.vertex, reach);
}

Answer BoundingPlanes::test(const MovingTriangle& triangle, const Reach& reach) const {
  std::array<Vec3, 6> vertices;
  std::copy_n(triangle.start.vertex, 3, vertices.begin());
  std::copy_n(triangle.end.vertex, 3, vertices.begin() + 3);
  return test_points(vertices, reach);
}

/// The centre must lie beyond a plane by more than the radius times the length of the normal, (slope, 1).
Answer BoundingPlanes::test(const Sphere& sphere, const Reach& reach) const {
  const IntervalVector centre = numeric::difference(sphere.centre, reference_);
  const Interval radius = Interval::point(std::fabs(sphere.radius)), ball{-radius.hi, radius.hi};
  const IntervalVector extent = {centre.x + ball, centre.y + ball, centre.z + ball};
  for (int axis = 0; axis < 3; ++axis)
    if (overlap(extent[axis], around_[axis]).empty()) return Answer::AllMiss;
  if (!frustum_) return Answer::Undecided;
  if ((backward_ ? -extent[axis_] : extent[axis_]).lo > reach.forward) return Answer::AllMiss;
  const auto margin = [&](float slope) {
    return radius * numeric::root(square(Interval::point(slope)) + Interval::point(1));
  };
  for (const FrustumSide& side : frustum_->side) {
    const Beyond centre_beyond = beyond(side, centre);
    if ((centre_beyond.low - margin(side.low_slope)).positive()) return Answer::AllMiss;
    if ((centre_beyond.high - margin(side.high_slope)).positive()) return Answer::AllMiss;
  }
  return Answer::Undecided;
}

bool BoundingPlanes::surrounds(const Box& box) const {
  if (!frustum_) return false;
  const IntervalVector extent = unite(numeric::difference(box.lo, reference_), numeric::difference(box.hi, reference_));
  const auto between = [&](const FrustumSide& side) {
    const Beyond distance = beyond(side, extent);
    return distance.low.hi <= 0 && distance.high.hi <= 0;
  };
  return (backward_ ? -extent[axis_] : extent[axis_]).hi >= frustum_->back && between(frustum_->side[0]) &&
         between(frustum_->side[1]);
}

}  // namespace ctu::cull::packet
