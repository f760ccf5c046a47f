#include "model/intersect/ray.h"

#include <cmath>

#include "model/numeric/round.h"

namespace ctu::intersect {

using numeric::Round;

namespace {

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

int largest_axis(const Vec3& d) {
  const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  if (z >= x && z >= y) return 2;
  return y >= x ? 1 : 0;
}

}  // namespace

bool is_valid(const Ray& ray) {
  const Vec3& d = ray.direction;
  const bool moves = d.x != 0 || d.y != 0 || d.z != 0;
  return is_finite(ray.origin) && is_finite(d) && moves && std::isfinite(ray.tmin) && ray.tmin <= ray.tmax;
}

bool same_bits(const Hit& a, const Hit& b) {
  using numeric::bits;
  return bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v) && a.primitive == b.primitive;
}

PreparedRay prepare_ray(const Ray& ray) {
  PreparedRay prepared;
  prepared.ray = ray;
  prepared.valid = is_valid(ray);
  if (!prepared.valid) return prepared;
  const Vec3& d = ray.direction;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0) {
      prepared.zero_axes = static_cast<std::uint8_t>(prepared.zero_axes | 1u << axis);
      continue;
    }
    if (d[axis] < 0) prepared.negative_axes = static_cast<std::uint8_t>(prepared.negative_axes | 1u << axis);
    prepared.rcp_down[axis] = numeric::div<Round::Down>(1.0f, d[axis]);
    prepared.rcp_up[axis] = numeric::div<Round::Up>(1.0f, d[axis]);
  }
  // A cyclic permutation keeps the winding when the ray runs towards +kz; the swap keeps it when it runs towards -kz.
  const int kz = largest_axis(d);
  int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
  if (d[kz] < 0) {
    const int swapped = kx;
    kx = ky;
    ky = swapped;
  }
  prepared.kx = static_cast<std::uint8_t>(kx);
  prepared.ky = static_cast<std::uint8_t>(ky);
  prepared.kz = static_cast<std::uint8_t>(kz);
  prepared.sx = numeric::div<Round::Nearest>(d[kx], d[kz]);
  prepared.sy = numeric::div<Round::Nearest>(d[ky], d[kz]);
  return prepared;
}

}  // namespace ctu::intersect
