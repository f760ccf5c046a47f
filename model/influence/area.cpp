#include "model/influence/area.h"

#include <cmath>
#include <initializer_list>

#include "model/base/error.h"
#include "model/scene/vector64.h"

namespace ctu::influence {
namespace {

using scene::Vector64;

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Bounded dot(const Vec3& a, const BoundedPoint& b) {
  return b.x * Bounded(a.x) + b.y * Bounded(a.y) + b.z * Bounded(a.z);
}

/// Corners, normals of faces and edges: 3 and 3 directions of a box, 5 and 6 of a frustum (A.5).
ConvexBody body_of(const InfluenceArea& area) {
  ConvexBody body;
  const bool converges = area.kind == AreaKind::Point;
  const double half_x = area.half_x, half_y = area.half_y;
  for (const double z : {double(area.near), double(area.far)})
    for (const double y : {-half_y, half_y})
      for (const double x : {-half_x, half_x}) {
        const double scale = converges ? z : 1;  // two binary32 numbers: the products are exact
        body.add_corner({x * scale, y * scale, z});
      }
  body.add_normal({0, 0, 1});
  body.add_edge({1, 0, 0});
  body.add_edge({0, 1, 0});
  if (!converges) {
    body.add_normal({1, 0, 0});
    body.add_normal({0, 1, 0});
    body.add_edge({0, 0, 1});
    return body;
  }
  for (const double side : {-1.0, 1.0}) {
    body.add_normal({side, 0, -half_x});
    body.add_normal({0, side, -half_y});
    body.add_edge({side * half_x, half_y, 1});
    body.add_edge({side * half_x, -half_y, 1});
  }
  return body;
}

Axis3 difference(const BoundedPoint& a, const BoundedPoint& b) {
  return {a.x.value - b.x.value, a.y.value - b.y.value, a.z.value - b.z.value};
}

}  // namespace

const char* to_string(AreaKind kind) { return kind == AreaKind::Plane ? "plane" : "point"; }

const char* problem_of(const InfluenceArea& area) {
  bool finite = is_finite(area.origin);
  for (const Vec3& axis : area.axes) finite = finite && is_finite(axis);
  for (const float x : {area.half_x, area.half_y, area.near, area.far}) finite = finite && std::isfinite(x);
  if (!finite) return "a number of it is not finite";
  const Vector64 u(area.axes[0]), v(area.axes[1]), w(area.axes[2]);
  if (!(std::fabs(scene::dot(scene::cross(u, v), w)) > 0)) return "its axes do not span space";
  if (area.half_x < 0 || area.half_y < 0) return "a width of it is negative";
  if (area.near > area.far) return "it ends before it begins";
  if (area.kind == AreaKind::Point && area.near < 0) return "it begins behind its focal point";
  return nullptr;
}

std::array<Vec3, 3> frame_along(const Vec3& direction, const Vec3& across) {
  const Vector64 w = normalized(Vector64(direction), {0, 0, 1});
  const Vector64 a(across);
  const Vector64 u = normalized(a - w * scene::dot(a, w), any_across(w));
  return {u.rounded(), cross(w, u).rounded(), w.rounded()};
}

PreparedArea::PreparedArea(const InfluenceArea& area) : area_(area) {
  if (const char* const problem = problem_of(area))
    throw Error("influence area", problem, "describe a box or a frustum");
  body_ = body_of(area);
}

BoundedPoint PreparedArea::to_local(const Vec3& p) const {
  const Vec3& o = area_.origin;
  const BoundedPoint from_origin{Bounded(p.x) - Bounded(o.x), Bounded(p.y) - Bounded(o.y), Bounded(p.z) - Bounded(o.z)};
  return {dot(area_.axes[0], from_origin), dot(area_.axes[1], from_origin), dot(area_.axes[2], from_origin)};
}

BoundedPoint PreparedArea::direction_to_local(const Vec3& d) const {
  const BoundedPoint exact{d.x, d.y, d.z};
  return {dot(area_.axes[0], exact), dot(area_.axes[1], exact), dot(area_.axes[2], exact)};
}

bool PreparedArea::certainly_contains(const BoundedPoint& q) const {
  const Bounded scale = area_.kind == AreaKind::Point ? q.z : Bounded(1);
  const Bounded room_x = scale * Bounded(area_.half_x), room_y = scale * Bounded(area_.half_y);
  return q.z.lower() >= area_.near && q.z.upper() <= area_.far && (room_x - q.x).lower() >= 0 &&
         (room_x + q.x).lower() >= 0 && (room_y - q.y).lower() >= 0 && (room_y + q.y).lower() >= 0;
}

bool PreparedArea::certainly_contains(const intersect::Ray& ray, float t) const {
  const BoundedPoint o = to_local(ray.origin), d = direction_to_local(ray.direction);
  const Bounded at(t);
  return certainly_contains(BoundedPoint{o.x + at * d.x, o.y + at * d.y, o.z + at * d.z});
}

bool PreparedArea::certainly_contains(const Vec3& lower, const Vec3& upper) const {
  for (int corner = 0; corner < 8; ++corner)
    if (!certainly_contains(Vec3{(corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                                 (corner & 4) != 0 ? upper.z : lower.z}))
      return false;
  return true;
}

bool PreparedArea::may_touch(const Vec3& v0, const Vec3& v1, const Vec3& v2) const {
  ConvexBody triangle;
  for (const Vec3& v : {v0, v1, v2}) {
    triangle.add_corner(to_local(v));
    if (certainly_contains(triangle.corner[triangle.corners - 1])) return true;
  }
  for (std::size_t i = 0; i < 3; ++i) triangle.add_edge(difference(triangle.corner[(i + 1) % 3], triangle.corner[i]));
  triangle.add_normal(cross(triangle.edge[0], triangle.edge[1]));
  return !certainly_apart(body_, triangle);
}

bool PreparedArea::may_touch(const Vec3& lower, const Vec3& upper) const {
  ConvexBody box;
  for (int corner = 0; corner < 8; ++corner)
    box.add_corner(to_local({(corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                             (corner & 4) != 0 ? upper.z : lower.z}));
  for (int axis = 0; axis < 3; ++axis) box.add_edge({area_.axes[0][axis], area_.axes[1][axis], area_.axes[2][axis]});
  for (std::size_t i = 0; i < 3; ++i) box.add_normal(cross(box.edge[(i + 1) % 3], box.edge[(i + 2) % 3]));
  return !certainly_apart(body_, box);
}

}  // namespace ctu::influence
