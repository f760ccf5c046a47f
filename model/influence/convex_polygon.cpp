#include "model/influence/convex_polygon.h"

#include <algorithm>
#include <cassert>

namespace ctu::influence {
namespace {

/// Appends to a chain that turns left all along.
void extend(ConvexPolygon& chain, std::size_t first, const Point2& p) {
  while (chain.size() >= first + 2 && turn(chain[chain.size() - 2], chain[chain.size() - 1], p) <= 0) chain.pop_back();
  chain.push_back(p);
}

/// The part of `polygon` on the left of the line from a to b.
ConvexPolygon left_part(const ConvexPolygon& polygon, const Point2& a, const Point2& b) {
  ConvexPolygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 &from = polygon[i], &to = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    const double side_from = turn(a, b, from), side_to = turn(a, b, to);
    if (side_from >= 0) part.push_back(from);
    if ((side_from > 0 && side_to < 0) || (side_from < 0 && side_to > 0)) {
      const double share = side_from / (side_from - side_to);
      part.push_back({from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)});
    }
  }
  return part;
}

}  // namespace

ConvexPolygon convex_hull(std::span<Point2> points) {
  assert(points.size() < ConvexPolygon::kMostVertices);
  std::sort(points.begin(), points.end(),
            [](const Point2& a, const Point2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const auto last = std::unique(points.begin(), points.end());
  const std::size_t n = static_cast<std::size_t>(last - points.begin());
  ConvexPolygon hull;
  if (n < 3) {
    for (std::size_t i = 0; i < n; ++i) hull.push_back(points[i]);
    return hull;
  }
  for (std::size_t i = 0; i < n; ++i) extend(hull, 0, points[i]);
  const std::size_t upper = hull.size() - 1;
  for (std::size_t i = n - 1; i-- > 0;) extend(hull, upper, points[i]);
  hull.pop_back();  // the first point again
  return hull;
}

ConvexPolygon rectangle(double half_x, double half_y) {
  ConvexPolygon polygon;
  for (const Point2& p :
       {Point2{-half_x, -half_y}, Point2{half_x, -half_y}, Point2{half_x, half_y}, Point2{-half_x, half_y}})
    polygon.push_back(p);
  return polygon;
}

bool contains(const ConvexPolygon& polygon, const Point2& point) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (turn(polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1], point) < 0) return false;
  return polygon.size() >= 3;
}

ConvexPolygon overlap(const ConvexPolygon& a, const ConvexPolygon& b) {
  assert(a.size() + b.size() <= ConvexPolygon::kMostVertices);
  if (b.size() < 3) return {};
  ConvexPolygon common = a;
  for (std::size_t i = 0; i < b.size() && common.size() > 0; ++i)
    common = left_part(common, b[i], b[i + 1 == b.size() ? 0 : i + 1]);
  return common;
}

double area(const ConvexPolygon& polygon) {
  double doubled = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) doubled += turn(polygon[0], polygon[i - 1], polygon[i]);
  return 0.5 * doubled;
}

}  // namespace ctu::influence
