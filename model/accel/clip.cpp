#include "model/accel/clip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/numeric/round.h"

namespace ctu::accel {
namespace {

float rounded_down(double x) {
  const float nearest = static_cast<float>(x);
  return static_cast<double>(nearest) > x ? numeric::next_down(nearest) : nearest;
}
float rounded_up(double x) {
  const float nearest = static_cast<float>(x);
  return static_cast<double>(nearest) < x ? numeric::next_up(nearest) : nearest;
}

/// Bounds in binary64, grown point by point.
struct WideBox {
  double lower[3], upper[3];

  WideBox() {
    std::fill_n(lower, 3, std::numeric_limits<double>::infinity());
    std::fill_n(upper, 3, -std::numeric_limits<double>::infinity());
  }
  void grow(const double (&low)[3], const double (&high)[3]) {
    for (int a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], low[a]);
      upper[a] = std::max(upper[a], high[a]);
    }
  }
};

bool lies_on(Side side, double x, double plane) { return side == Side::Lower ? x <= plane : x >= plane; }

/// Where the edge from p to q crosses the plane. Differences of binary32 numbers are off by 2^-53 of their size, the
/// share by 3 * 2^-53 of 1, the point by less than 2^-49 of the larger coordinate.
void grow_by_crossing(const Vec3& p, const Vec3& q, int axis, double plane, WideBox& out) {
  const double share = (plane - p[axis]) / (double{q[axis]} - p[axis]);
  double low[3], high[3];
  for (int a = 0; a < 3; ++a) {
    const double at = p[a] + (double{q[a]} - p[a]) * share;
    const double error = 0x1p-48 * std::max(std::fabs(double{p[a]}), std::fabs(double{q[a]}));
    low[a] = at - error;
    high[a] = at + error;
  }
  low[axis] = high[axis] = plane;
  out.grow(low, high);
}

WideBox side_of_triangle(const LeafTriangle& t, int axis, double plane, Side side) {
  WideBox bounds;
  const Vec3 corners[3] = {t.v0, t.v1, t.v2};
  for (int i = 0; i < 3; ++i) {
    const Vec3 &p = corners[i], &q = corners[(i + 1) % 3];
    const double point[3] = {p.x, p.y, p.z};
    const bool here = lies_on(side, p[axis], plane);
    if (here) bounds.grow(point, point);
    if (here != lies_on(side, q[axis], plane)) grow_by_crossing(p, q, axis, plane, bounds);
  }
  return bounds;
}

/// The cap is as wide as the ball where the plane leaves the centre to it, else as its circle in the plane. The square
/// of its radius is off by less than 2^-50 of the ball's.
WideBox side_of_sphere(const scene::Sphere& s, int axis, double plane, Side side) {
  WideBox bounds;
  const double r = s.radius, away = plane - s.centre[axis];
  const bool has_centre = lies_on(side, s.centre[axis], plane);
  if (!has_centre && std::fabs(away) > r) return bounds;
  const double square = r * r,
               wide = has_centre ? r : std::sqrt(std::max(square - away * away, 0.0) + 0x1p-49 * square);
  double low[3], high[3];
  for (int a = 0; a < 3; ++a) {
    const double reach = a == axis ? r : std::min(wide, r);
    low[a] = s.centre[a] - reach;
    high[a] = s.centre[a] + reach;
    // One rounding each, at 2^-53 of the sum.
    low[a] -= 0x1p-50 * std::fabs(low[a]);
    high[a] += 0x1p-50 * std::fabs(high[a]);
  }
  bounds.grow(low, high);
  return bounds;
}

}  // namespace

std::optional<PrimitiveBox> clipped_box(const LeafTriangle& primitive, const PrimitiveBox& box, int axis, float plane,
                                        Side side) {
  const WideBox bounds = primitive.is_sphere() ? side_of_sphere(primitive.sphere(), axis, plane, side)
                                               : side_of_triangle(primitive, axis, plane, side);
  PrimitiveBox part;
  for (int a = 0; a < 3; ++a) {
    part.lower[a] = std::max(box.lower[a], rounded_down(bounds.lower[a]));
    part.upper[a] = std::min(box.upper[a], rounded_up(bounds.upper[a]));
  }
  float& limit = side == Side::Lower ? part.upper[axis] : part.lower[axis];
  limit = side == Side::Lower ? std::min(limit, plane) : std::max(limit, plane);
  for (int a = 0; a < 3; ++a)
    if (!(part.lower[a] <= part.upper[a])) return std::nullopt;
  return part;
}

}  // namespace ctu::accel
