#include "model/intersect/sphere_test.h"

#include <array>
#include <cmath>

#include "model/intersect/round24.h"

namespace ctu::intersect {
namespace {

using Wide3 = std::array<double, 3>;

Wide3 widen(const Vec3& v) { return {v.x, v.y, v.z}; }

double dot(const Wide3& a, const Wide3& b) {
  return round24(round24(round24(a[0] * b[0]) + round24(a[1] * b[1])) + round24(a[2] * b[2]));
}

}  // namespace

SphereResult sphere_test(const PreparedRay& ray, const scene::Sphere& sphere, float tmax) {
  const Wide3 direction = widen(ray.ray.direction), origin = widen(ray.ray.origin), centre = widen(sphere.centre);
  Wide3 from_centre, nearest;
  for (std::size_t axis = 0; axis < 3; ++axis) from_centre[axis] = round24(origin[axis] - centre[axis]);
  const double a = dot(direction, direction);
  const double s = -round24(dot(from_centre, direction) / a);
  for (std::size_t axis = 0; axis < 3; ++axis)
    nearest[axis] = round24(from_centre[axis] + round24(s * direction[axis]));
  const double radius = sphere.radius;
  const double delta = round24(round24(radius * radius) - dot(nearest, nearest));
  if (delta < 0) return {};
  const double half = round24(std::sqrt(round24(delta / a)));
  for (const double at : {s - half, s + half}) {
    const float t = static_cast<float>(round24(at)) + 0.0f;
    if (!(ray.ray.tmin <= t)) continue;
    return t <= tmax ? SphereResult{true, t} : SphereResult{};
  }
  return {};
}

}  // namespace ctu::intersect
