#include "traces/sampling.h"

#include <cmath>

#include <Random123/philox.h>

namespace ctu::traces {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

std::array<double, 4> random_numbers(std::uint64_t seed, std::uint64_t item, std::uint32_t sample,
                                     std::uint32_t dimension) {
  r123::Philox4x32 generator;
  const r123::Philox4x32::ctr_type counter = {
      {static_cast<std::uint32_t>(item), static_cast<std::uint32_t>(item >> 32), sample, dimension}};
  const r123::Philox4x32::key_type key = {{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const auto words = generator(counter, key);
  return {words[0] * 0x1p-32, words[1] * 0x1p-32, words[2] * 0x1p-32, words[3] * 0x1p-32};
}

double length(const Vec3d& v) { return std::sqrt(dot(v, v)); }

Vec3d normalized(const Vec3d& v, const Vec3d& fallback) {
  const double size = length(v);
  if (!(size > 0) || !std::isfinite(size)) return fallback;
  return {v.x / size, v.y / size, v.z / size};
}

SinCos sin_cos(double x) {
  // Horner from the last term that binary64 can see: (pi/2)^24 / 24! < 1e-19.
  double sine = 1, cosine = 1;
  for (int n = 24; n >= 2; n -= 2) {
    sine = 1 - x * x / (n * (n + 1)) * sine;
    cosine = 1 - x * x / (n * (n - 1)) * cosine;
  }
  return {x * sine, cosine};
}

DiskPoint disk_point(double u, double v) {
  const double a = 2 * u - 1, b = 2 * v - 1;
  if (a == 0 && b == 0) return {0, 0};
  if (std::abs(a) > std::abs(b)) {
    const SinCos angle = sin_cos(kPi / 4 * (b / a));
    return {a * angle.cos, a * angle.sin};
  }
  const SinCos angle = sin_cos(kPi / 4 * (a / b));
  return {b * angle.sin, b * angle.cos};
}

Vec3d sphere_point(double u, double v) {
  const DiskPoint p = disk_point(u, v);
  const double r2 = p.x * p.x + p.y * p.y;
  const double scale = 2 * std::sqrt(r2 < 1 ? 1 - r2 : 0);
  return {p.x * scale, p.y * scale, 1 - 2 * r2};
}

Vec3d cosine_direction(const Vec3d& normal, double u, double v) {
  const DiskPoint p = disk_point(u, v);
  const double r2 = p.x * p.x + p.y * p.y;
  const double height = std::sqrt(r2 < 1 ? 1 - r2 : 0);
  // A basis about the normal without a branch on its size: Duff et al. 2017, "Building an Orthonormal Basis,
  // Revisited".
  const double sign = std::copysign(1.0, normal.z);
  const double a = -1 / (sign + normal.z);
  const double b = normal.x * normal.y * a;
  const Vec3d tangent = {1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
  const Vec3d bitangent = {b, sign + normal.y * normal.y * a, -normal.y};
  return tangent * p.x + bitangent * p.y + normal * height;
}

}  // namespace ctu::traces
