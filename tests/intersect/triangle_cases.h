// Random rays and triangles for both files of triangle tests: every scale, aimed at vertices, edges and beside.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <sstream>
#include <string>

#include "model/intersect/ray.h"
#include "model/numeric/round.h"

namespace ctu::intersect {

struct TriangleCase {
  Ray ray;
  Vec3 v[3];
};

class TriangleCases {
 public:
  explicit TriangleCases(std::uint64_t seed) : bits_(seed) {}

  /// Of size about `size`; the ray starts some sizes away and aims at a point of the triangle, or just beside it.
  TriangleCase next(double size) {
    TriangleCase c;
    for (Vec3& v : c.v) v = point(size);
    if (chance(0.05)) c.v[2] = c.v[1];
    if (chance(0.1)) c.v[1].x = c.v[0].x, c.v[2].x = c.v[0].x;
    c.ray.origin = point(chance(0.9) ? 3 * size : 1e3 * size);
    const double spread = chance(0.3) ? 0 : chance(0.5) ? 1e-7 : 1;
    double w[3] = {1, 0, 0};  // a vertex
    if (chance(0.7)) w[1] = uniform(0, 1), w[0] = 1 - w[1];
    if (chance(0.5)) w[2] = uniform(0, 1), w[0] *= 1 - w[2], w[1] *= 1 - w[2];
    for (int axis = 0; axis < 3; ++axis) {
      double aim = 0;
      for (int i = 0; i < 3; ++i) aim += w[i] * c.v[i][axis];
      c.ray.direction[axis] = static_cast<float>(aim + spread * size * uniform(-1, 1) - c.ray.origin[axis]);
    }
    if (chance(0.05)) c.ray.direction[static_cast<int>(bits_() % 3)] = 0;
    if (chance(0.05)) c.ray.direction[static_cast<int>(bits_() % 3)] *= 1e-38f;
    c.ray.tmax = std::numeric_limits<float>::infinity();
    return c;
  }

  double uniform(double from, double to) { return from + (to - from) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
  bool chance(double share) { return uniform(0, 1) < share; }
  double power_of_ten(double from, double to) { return std::pow(10.0, uniform(from, to)); }

 private:
  Vec3 point(double size) {
    const auto coordinate = [&] { return static_cast<float>(size * uniform(-1, 1)); };
    return {coordinate(), coordinate(), coordinate()};
  }

  std::mt19937_64 bits_;
};

inline std::string show(const TriangleCase& c) {
  std::ostringstream text;
  const auto add = [&](const char* name, const Vec3& v) {
    text << "\n" << name << std::hex;
    for (int axis = 0; axis < 3; ++axis) text << " 0x" << numeric::bits(v[axis]);
    text << std::dec << " (" << v.x << ", " << v.y << ", " << v.z << ")";
  };
  add("origin", c.ray.origin);
  add("direction", c.ray.direction);
  for (const Vec3& v : c.v) add("vertex", v);
  return text.str();
}

}  // namespace ctu::intersect
