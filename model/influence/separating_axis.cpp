#include "model/influence/separating_axis.h"

#include <algorithm>
#include <limits>

namespace ctu::influence {
namespace {

struct Extent {
  double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();
};

Extent project(const Axis3& axis, const ConvexBody& body) {
  Extent extent;
  for (std::size_t i = 0; i < body.corners; ++i) {
    const BoundedPoint& p = body.corner[i];
    const Bounded at = p.x * axis.x + p.y * axis.y + p.z * axis.z;
    extent.from = std::min(extent.from, at.lower());
    extent.to = std::max(extent.to, at.upper());
  }
  return extent;
}

}  // namespace

bool apart_along(const Axis3& axis, const ConvexBody& a, const ConvexBody& b) {
  const Extent in_a = project(axis, a), in_b = project(axis, b);
  return in_a.to < in_b.from || in_b.to < in_a.from;
}

bool certainly_apart(const ConvexBody& a, const ConvexBody& b) {
  for (std::size_t i = 0; i < a.normals; ++i)
    if (apart_along(a.normal[i], a, b)) return true;
  for (std::size_t i = 0; i < b.normals; ++i)
    if (apart_along(b.normal[i], a, b)) return true;
  for (std::size_t i = 0; i < a.edges; ++i)
    for (std::size_t j = 0; j < b.edges; ++j)
      if (apart_along(cross(a.edge[i], b.edge[j]), a, b)) return true;
  return false;
}

}  // namespace ctu::influence
