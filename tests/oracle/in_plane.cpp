#include "tests/oracle/in_plane.h"

#include <cmath>

#include "tests/oracle/exact_sum.h"

namespace ctu::oracle {

namespace {

using intersect::Ray;

/// The two axes that are left when one is dropped.
struct Plane {
  int x, y;
  explicit Plane(int dropped) : x((dropped + 1) % 3), y((dropped + 2) % 3) {}
};

double product(float a, float b) { return static_cast<double>(a) * b; }

/// Adds scale (q - p) x r, in the plane.
void add_turn(ExactSum& sum, double scale, const Plane& at, const Vec3& p, const Vec3& q, const Vec3& r) {
  sum.add_product(scale, product(q[at.x], r[at.y]));
  sum.add_product(-scale, product(p[at.x], r[at.y]));
  sum.add_product(-scale, product(q[at.y], r[at.x]));
  sum.add_product(scale, product(p[at.y], r[at.x]));
}

/// The sign of (q - p) x r.
int turn_along(const Plane& at, const Vec3& p, const Vec3& q, const Vec3& r) {
  ExactSum sum;
  add_turn(sum, 1, at, p, q, r);
  return sum.sign();
}

/// The sign of (q - p) x (r - p): on which side of p q the point r lies.
int side_of(const Plane& at, const Vec3& p, const Vec3& q, const Vec3& r) {
  ExactSum sum;
  add_turn(sum, 1, at, p, q, r);
  add_turn(sum, -1, at, p, q, p);
  return sum.sign();
}

/// The same for the point o + t d; at infinity that of the direction, or of the origin beside a parallel line.
int side_of_time(const Plane& at, const Vec3& p, const Vec3& q, const Ray& ray, float t) {
  if (std::isinf(t)) {
    const int along = turn_along(at, p, q, ray.direction);
    return along != 0 ? along : side_of(at, p, q, ray.origin);
  }
  ExactSum sum;
  add_turn(sum, 1, at, p, q, ray.origin);
  add_turn(sum, t, at, p, q, ray.direction);
  add_turn(sum, -1, at, p, q, p);
  return sum.sign();
}

/// Whether the line through p and q has all of the ray on the far side of `inner`, a side of it.
bool separates(const Plane& at, const Vec3& p, const Vec3& q, int inner, const Ray& ray) {
  return side_of_time(at, p, q, ray, ray.tmin) == -inner && side_of_time(at, p, q, ray, ray.tmax) == -inner;
}

/// The sign of d x (p - o): on which side of the ray's line p lies.
int side_of_ray(const Plane& at, const Ray& ray, const Vec3& p) {
  return -turn_along(at, ray.origin, p, ray.direction);
}

/// Convex figures in a plane are apart iff a line along an edge of one of them parts them.
bool meets_area(const Plane& at, const Ray& ray, const Vec3 (&v)[3], int winding) {
  const int side = side_of_ray(at, ray, v[0]);
  if (side != 0 && side_of_ray(at, ray, v[1]) == side && side_of_ray(at, ray, v[2]) == side) return false;
  for (int i = 0; i < 3; ++i)
    if (separates(at, v[i], v[(i + 1) % 3], winding, ray)) return false;
  return true;
}

/// A segment in one plane with the ray, and not parallel to it in the projection.
bool meets_segment(const Plane& at, const Ray& ray, const Vec3& p, const Vec3& q) {
  const int side = side_of_ray(at, ray, p);
  if (side != 0 && side_of_ray(at, ray, q) == side) return false;
  return !separates(at, p, q, 1, ray) && !separates(at, p, q, -1, ray);
}

/// A segment parallel to the ray, or a point.
bool meets_along_line(const Ray& ray, const Vec3& p, const Vec3& q) {
  for (int dropped = 0; dropped < 3; ++dropped)
    if (side_of_ray(Plane(dropped), ray, p) != 0) return false;
  const int axis = ray.direction.x != 0 ? 0 : ray.direction.y != 0 ? 1 : 2;
  const auto past = [&](const Vec3& point, float t) {  // sign of the point's time - t
    if (std::isinf(t)) return -1;
    ExactSum sum;
    sum.add(point[axis]);
    sum.add(-static_cast<double>(ray.origin[axis]));
    sum.add(-product(t, ray.direction[axis]));
    return ray.direction[axis] > 0 ? sum.sign() : -sum.sign();
  };
  const bool before = past(p, ray.tmin) < 0 && past(q, ray.tmin) < 0;
  const bool behind = past(p, ray.tmax) > 0 && past(q, ray.tmax) > 0;
  return !before && !behind;
}

/// The ends of three points on a line: the lowest and the highest on an axis on which they differ.
void order_ends(const Vec3 (&v)[3], Vec3& p, Vec3& q) {
  int axis = 0;
  while (axis < 2 && v[0][axis] == v[1][axis] && v[1][axis] == v[2][axis]) ++axis;
  p = q = v[0];
  for (const Vec3& end : v) {
    if (end[axis] < p[axis]) p = end;
    if (end[axis] > q[axis]) q = end;
  }
}

}  // namespace

bool meets_in_plane(const Ray& ray, const Vec3 (&v)[3]) {
  for (int dropped = 0; dropped < 3; ++dropped) {
    const Plane at(dropped);
    const int winding = side_of(at, v[0], v[1], v[2]);
    if (winding != 0) return meets_area(at, ray, v, winding);
  }
  Vec3 p, q;
  order_ends(v, p, q);
  for (int dropped = 0; dropped < 3; ++dropped) {
    const Plane at(dropped);
    if (turn_along(at, p, q, ray.direction) != 0) return meets_segment(at, ray, p, q);
  }
  return meets_along_line(ray, p, q);
}

}  // namespace ctu::oracle
