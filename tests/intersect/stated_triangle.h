// The triangle test's own statement (the list of roundings at the top of triangle_test.h), done in rationals.
#pragma once

#include "model/intersect/triangle_test.h"
#include "tests/oracle/rational.h"

namespace ctu::intersect {

/// A vertex in the ray's space.
struct StatedCorner {
  oracle::Rational x, y, z;

  StatedCorner(const PreparedRay& ray, const Vec3& vertex) {
    using oracle::exact;
    using oracle::round24;
    const auto from_origin = [&](int axis) { return round24(exact(vertex[axis]) - exact(ray.ray.origin[axis])); };
    z = from_origin(ray.kz);
    x = round24(from_origin(ray.kx) - round24(exact(ray.sx) * z));
    y = round24(from_origin(ray.ky) - round24(exact(ray.sy) * z));
  }
};

/// What triangle_test() must give, bit for bit.
inline TriangleResult stated_triangle_test(const PreparedRay& ray, const Vec3 (&v)[3], float tmax) {
  using oracle::exact;
  using oracle::quotient_binary32;
  using oracle::Rational;
  using oracle::round24;
  const StatedCorner a(ray, v[0]), b(ray, v[1]), c(ray, v[2]);
  const Rational u = round24(c.x * b.y - c.y * b.x), w_of_b = round24(a.x * c.y - a.y * c.x),
                 w = round24(b.x * a.y - b.y * a.x);
  const bool negative = u < 0 || w_of_b < 0 || w<0, positive = u> 0 || w_of_b > 0 || w > 0;
  if (negative && positive) return {};
  const Rational det = round24(round24(u + w_of_b) + w);
  if (det == 0) return {};
  const Rational depth = round24(round24(round24(u * a.z) + round24(w_of_b * b.z)) + round24(w * c.z));
  const Rational scaled = round24(det * exact(ray.ray.direction[ray.kz]));
  const float t = quotient_binary32(depth / scaled);
  if (!(ray.ray.tmin <= t && t <= tmax)) return {};
  return {true, t, quotient_binary32(w_of_b / det), quotient_binary32(w / det)};
}

}  // namespace ctu::intersect
