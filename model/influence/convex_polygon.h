// Convex polygons in a plane, for projected areas: hull, overlap and area (appendix A.8 to A.10 of the ray-distribution
// paper). In binary64 and rounded: they weigh costs, they decide no hit.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace ctu::influence {

struct Point2 {
  double x = 0, y = 0;
  bool operator==(const Point2&) const = default;
};

/// Twice the signed area of the triangle a, b, c: above 0 when c lies to the left of the line from a to b.
inline double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Vertices counter-clockwise; none, one or two of them have no area.
class ConvexPolygon {
 public:
  /// The projection of a box that two planes have cut (14 corners at most), cut by the four sides of a cross-section.
  static constexpr std::size_t kMostVertices = 32;

  std::size_t size() const { return size_; }
  const Point2& operator[](std::size_t i) const { return vertex_[i]; }
  std::span<const Point2> vertices() const { return {vertex_.data(), size_}; }
  void push_back(const Point2& p) { vertex_[size_++] = p; }
  void pop_back() { --size_; }
  void clear() { size_ = 0; }

 private:
  std::array<Point2, kMostVertices> vertex_;
  std::size_t size_ = 0;
};

/// The smallest convex polygon around at most kMostVertices - 1 points, which it reorders (Andrew 1979).
ConvexPolygon convex_hull(std::span<Point2> points);

/// The rectangle |x| <= half_x, |y| <= half_y.
ConvexPolygon rectangle(double half_x, double half_y);

/// Whether the point is in the polygon or on its border: on no edge's right (A.8).
bool contains(const ConvexPolygon& polygon, const Point2& point);

/// What the two have in common (A.9). The paper gathers the vertices of each inside the other and the crossings of
/// their edges, and sorts them by angle; cutting by one edge after the other (Sutherland and Hodgman 1974) gives them
/// in order, without an arc tangent. Both together have at most kMostVertices vertices.
ConvexPolygon overlap(const ConvexPolygon& a, const ConvexPolygon& b);

/// The shoelace formula (A.10), about the first vertex, so that far-off polygons lose nothing.
double area(const ConvexPolygon& polygon);

}  // namespace ctu::influence
