// Random rays and spheres: every scale, far off, from inside, and past the silhouette.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <sstream>
#include <string>

#include "model/intersect/ray.h"
#include "model/numeric/round.h"
#include "model/scene/sphere.h"

namespace ctu::intersect {

struct SphereCase {
  Ray ray;
  scene::Sphere sphere;
};

class SphereCases {
 public:
  explicit SphereCases(std::uint64_t seed) : bits_(seed) {}

  /// Coordinates about `size`; the ray aims at the ball, in one of three cases at its silhouette.
  SphereCase next(double size) {
    SphereCase c;
    c.sphere = {point(size), static_cast<float>(size * (chance(0.5) ? uniform(0, 1) : power_of_ten(-6, 0)))};
    if (chance(0.02)) c.sphere.radius = 0;
    c.ray.origin = chance(0.15) ? c.sphere.centre : point(size);
    for (int axis = 0; axis < 3; ++axis) c.ray.origin[axis] += static_cast<float>(offset() * size);
    const bool grazing = chance(1.0 / 3);
    double out[3], along[3], across = 0, square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      out[axis] = uniform(-1, 1);
      along[axis] = static_cast<double>(c.sphere.centre[axis]) - c.ray.origin[axis];
      across += out[axis] * along[axis];
      square += along[axis] * along[axis];
    }
    double length = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (grazing && square > 0) out[axis] -= across / square * along[axis];
      length += out[axis] * out[axis];
    }
    const double far = (grazing ? 1 + uniform(-1, 1) * power_of_ten(-9, -1) : uniform(0, 1.3)) * c.sphere.radius;
    for (int axis = 0; axis < 3; ++axis)
      c.ray.direction[axis] = static_cast<float>(along[axis] + out[axis] / std::sqrt(length) * far);
    if (chance(0.05)) c.ray.direction[static_cast<int>(bits_() % 3)] = 0;
    const float scale = chance(0.5) ? 1.0f : static_cast<float>(power_of_ten(-3, 3));
    for (int axis = 0; axis < 3; ++axis) c.ray.direction[axis] *= scale;
    c.ray.tmax = chance(0.7) ? std::numeric_limits<float>::infinity() : static_cast<float>(uniform(0, 2) / scale);
    if (chance(0.2)) c.ray.tmin = std::fmin(c.ray.tmax, static_cast<float>(uniform(-1, 1) / scale));
    return c;
  }

  double uniform(double from, double to) { return from + (to - from) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
  bool chance(double share) { return uniform(0, 1) < share; }
  double power_of_ten(double from, double to) { return std::pow(10.0, uniform(from, to)); }

 private:
  double offset() { return chance(0.5) ? uniform(-3, 3) : chance(0.5) ? 0 : uniform(-1, 1) * power_of_ten(-6, 3); }
  Vec3 point(double size) {
    const auto coordinate = [&] { return static_cast<float>(size * uniform(-1, 1)); };
    return {coordinate(), coordinate(), coordinate()};
  }

  std::mt19937_64 bits_;
};

inline std::string show(const SphereCase& c) {
  std::ostringstream text;
  const auto add = [&](const char* name, float x) {
    text << "\n" << name << std::hex << " 0x" << numeric::bits(x) << std::dec << " (" << x << ")";
  };
  for (int axis = 0; axis < 3; ++axis) add("origin", c.ray.origin[axis]);
  for (int axis = 0; axis < 3; ++axis) add("direction", c.ray.direction[axis]);
  add("tmin", c.ray.tmin);
  add("tmax", c.ray.tmax);
  for (int axis = 0; axis < 3; ++axis) add("centre", c.sphere.centre[axis]);
  add("radius", c.sphere.radius);
  return text.str();
}

}  // namespace ctu::intersect
