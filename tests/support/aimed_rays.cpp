#include "tests/support/aimed_rays.h"

#include <cmath>
#include <limits>

namespace ctu::test {

using intersect::Ray;

namespace {
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}  // namespace

const char* to_string(Family family) {
  static const char* const kNames[] = {"inside-out",      "outside",       "far 1e4",        "far 1e6",
                                       "axis-parallel",   "one zero",      "tiny component", "subnormal component",
                                       "direction 1e-10", "direction 1e10"};
  return kNames[static_cast<int>(family)];
}

Ray AimedRays::next(Family family) {
  const Vec3 target = surface_point(), middle = near_middle();
  Ray ray;
  ray.tmax = kInfinity;
  const double reach = family == Family::Far4 ? 1e4 : family == Family::Far6 ? 1e6 : 3;
  const bool along_axis = family == Family::AxisParallel || family == Family::OneZero || family == Family::Tiny ||
                          family == Family::Subnormal;
  const int zero_axis = static_cast<int>(random_() % 3), long_axis = (zero_axis + 1) % 3;
  for (int axis = 0; axis < 3; ++axis) {
    if (family == Family::InsideOut || along_axis) {
      ray.origin[axis] = middle[axis];
      ray.direction[axis] = target[axis] - middle[axis];
    } else {
      const double inward = static_cast<double>(middle[axis]) - target[axis];
      ray.origin[axis] = static_cast<float>(target[axis] - reach * inward);
      ray.direction[axis] = target[axis] - ray.origin[axis];
    }
  }
  if (along_axis) bend(ray, target, family, zero_axis, long_axis);
  const float scale = family == Family::Scale1em10 ? 1e-10f : family == Family::Scale1e10 ? 1e10f : 1.0f;
  for (int axis = 0; axis < 3; ++axis) ray.direction[axis] *= scale;
  return ray;
}

Vec3 AimedRays::surface_point() {
  const auto& mesh = closed_.mesh;
  const auto& triangle = mesh.triangles[random_() % mesh.triangles.size()];
  const std::size_t corner = random_() % 3;
  const Vec3 a = mesh.vertices[triangle[corner]], b = mesh.vertices[triangle[(corner + 1) % 3]];
  if (random_() % 2) return a;
  const double w = uniform(0, 1);
  Vec3 point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(a[axis] + w * (double(b[axis]) - a[axis]));
  return point;
}

Vec3 AimedRays::near_middle() {
  Vec3 point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = static_cast<float>(closed_.middle[axis] + closed_.size * uniform(-0.2, 0.2));
  return point;
}

/// From inside along one axis, through the lattice planes of a surface point; other components zero or tiny.
void AimedRays::bend(Ray& ray, const Vec3& target, Family family, int zero_axis, int long_axis) {
  const double size = closed_.size;
  for (int axis = 0; axis < 3; ++axis) {
    const bool close = std::fabs(static_cast<double>(target[axis]) - closed_.middle[axis]) < 0.5 * size;
    if (axis == zero_axis || family != Family::OneZero) ray.origin[axis] = close ? target[axis] : ray.origin[axis];
    const float sign = random_() % 2 ? 1.0f : -1.0f;
    float small = sign * 0.0f;
    if (family == Family::Tiny) small = sign * static_cast<float>(size * std::pow(10.0, uniform(-30, -8)));
    if (family == Family::Subnormal) small = sign * static_cast<float>(uniform(0, 1e-38));
    if (axis == zero_axis || (family != Family::OneZero && axis != long_axis)) ray.direction[axis] = small;
    if (axis == long_axis) ray.direction[axis] = sign * static_cast<float>(size);
  }
}

}  // namespace ctu::test
