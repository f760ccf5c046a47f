// Random numbers and the maps from them to directions. Only operations that IEEE 754 defines exactly (+ - * / sqrt) are
// used, in binary64, so that a ray has the same bits on every machine and with every mathematics library.
#pragma once

#include <array>
#include <cstdint>

#include "model/numeric/vec3.h"

namespace ctu::traces {

/// Four numbers in [0, 1), multiples of 2^-32, that depend on the arguments alone: Philox4x32-10 (Salmon et al. 2011).
std::array<double, 4> random_numbers(std::uint64_t seed, std::uint64_t item, std::uint32_t sample,
                                     std::uint32_t dimension);

struct Vec3d {
  double x = 0, y = 0, z = 0;
  Vec3d operator+(const Vec3d& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Vec3d operator-(const Vec3d& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Vec3d operator*(double s) const { return {x * s, y * s, z * s}; }
};
inline Vec3d widen(const Vec3& v) { return {v.x, v.y, v.z}; }
inline Vec3 round_to_nearest(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(const Vec3d& v);
/// `fallback` when v has no direction (zero or not finite).
Vec3d normalized(const Vec3d& v, const Vec3d& fallback);

/// Sine and cosine of |x| <= pi/2 by their power series, to about 1e-16.
struct SinCos {
  double sin, cos;
};
SinCos sin_cos(double x);

/// Uniform on the unit disk (Shirley and Chiu 1997: concentric map).
struct DiskPoint {
  double x, y;
};
DiskPoint disk_point(double u, double v);

/// Uniform on the unit sphere: the disk under Lambert's equal-area map.
Vec3d sphere_point(double u, double v);

/// Cosine-weighted about the unit vector `normal` (Malley: the disk raised to the hemisphere), of length 1 but for
/// rounding.
Vec3d cosine_direction(const Vec3d& normal, double u, double v);

}  // namespace ctu::traces
