// Whether two convex bodies are apart, by separating axes (appendix A.5 of the ray-distribution paper): where they are,
// they are apart along a normal of a face or along the product of an edge of each.
//
// Corners are given with their bounds and an axis is taken as the binary64 vector it is, so an answer "apart" is proved
// whatever was rounded: any axis along which the projections, bounds included, do not meet is proof. Bodies that touch
// are never apart; bodies that miss each other by less than rounding may go unproved.
#pragma once

#include <array>
#include <cstddef>

#include "model/influence/bounded.h"

namespace ctu::influence {

struct Axis3 {
  double x = 0, y = 0, z = 0;
};
inline Axis3 cross(const Axis3& a, const Axis3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct BoundedPoint {
  Bounded x, y, z;
};

/// At most a box's or frustum's worth of corners, normals of faces and directions of edges.
struct ConvexBody {
  std::array<BoundedPoint, 8> corner;
  std::size_t corners = 0;
  std::array<Axis3, 6> normal, edge;
  std::size_t normals = 0, edges = 0;

  void add_corner(const BoundedPoint& p) { corner[corners++] = p; }
  void add_normal(const Axis3& n) { normal[normals++] = n; }
  void add_edge(const Axis3& e) { edge[edges++] = e; }
};

/// Whether the projections on the axis certainly do not meet. The null vector separates nothing.
bool apart_along(const Axis3& axis, const ConvexBody& a, const ConvexBody& b);

/// Whether some axis proves that the bodies have no point in common.
bool certainly_apart(const ConvexBody& a, const ConvexBody& b);

}  // namespace ctu::influence
