// Binary64 vectors: geometry is made in binary64 and rounded once to binary32 when it becomes a vertex.
#pragma once

#include <cmath>

#include "model/numeric/vec3.h"

namespace ctu::scene {

struct Vector64 {
  double x = 0, y = 0, z = 0;
  Vector64() = default;
  Vector64(double x_in, double y_in, double z_in) : x(x_in), y(y_in), z(z_in) {}
  explicit Vector64(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
  /// Rounds each coordinate to nearest even.
  Vec3 rounded() const { return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}; }
};

inline Vector64 operator+(const Vector64& a, const Vector64& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector64 operator-(const Vector64& a, const Vector64& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector64 operator*(const Vector64& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(const Vector64& a, const Vector64& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector64 cross(const Vector64& a, const Vector64& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vector64& a) { return std::sqrt(dot(a, a)); }

/// `a` with length one; `otherwise` if `a` is too short to have a direction.
inline Vector64 normalized(const Vector64& a, const Vector64& otherwise) {
  const double l = length(a);
  return l > 1e-150 && std::isfinite(l) ? a * (1 / l) : otherwise;
}

/// Some unit vector across `a`: the one with the axis that `a` is farthest from.
inline Vector64 any_across(const Vector64& a) {
  const double x = std::fabs(a.x), y = std::fabs(a.y), z = std::fabs(a.z);
  const Vector64 axis = x <= y && x <= z ? Vector64{1, 0, 0} : y <= z ? Vector64{0, 1, 0} : Vector64{0, 0, 1};
  return normalized(cross(a, axis), {1, 0, 0});
}

}  // namespace ctu::scene
