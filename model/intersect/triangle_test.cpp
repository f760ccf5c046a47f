#include "model/intersect/triangle_test.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "model/intersect/round24.h"

namespace ctu::intersect {

namespace {

/// R(p - q) for two exact products. The difference may need more than binary64's 53 bits; rounding it to odd keeps
/// the second rounding right (Boldo and Melquiond 2008). Its sign is exact at every step.
double round24_difference(double p, double q) {
  const double nearest = p - q;
  const double rest = p - nearest;
  const double error = (p - (nearest + rest)) + (rest - q);
  auto bits = std::bit_cast<std::uint64_t>(nearest);
  if (error != 0 && (bits & 1) == 0) bits += (error > 0) == (nearest > 0) ? 1 : std::uint64_t(-1);
  return round24(std::bit_cast<double>(bits));
}

/// The quotient of two 24-bit numbers rounded to binary32: through binary64 and once more, which is the same
/// (Figueroa 1995). A zero quotient is +0, so that equal results are equal bits.
float quotient(double p, double q) { return static_cast<float>(p / q) + 0.0f; }

struct Sheared {
  double x, y, z;  ///< z is the unsheared, unscaled distance along kz
};

Sheared shear_wide(const PreparedRay& ray, const Vec3& vertex) {
  const auto from_origin = [&](int axis) {
    return round24(static_cast<double>(vertex[axis]) - static_cast<double>(ray.ray.origin[axis]));
  };
  const double z = from_origin(ray.kz);
  return {round24(from_origin(ray.kx) - round24(static_cast<double>(ray.sx) * z)),
          round24(from_origin(ray.ky) - round24(static_cast<double>(ray.sy) * z)), z};
}

/// The shear in binary32, which is the same as long as no product underflows and nothing overflows: `same` is cleared
/// where that may happen.
class NarrowShear {
 public:
  explicit NarrowShear(const PreparedRay& ray)
      : kx_(ray.kx), ky_(ray.ky), kz_(ray.kz), sx_(ray.sx), sy_(ray.sy), origin_(coordinates(ray.ray.origin)) {
    same = zero_or_at_least(sx_, 0x1p-40f) & zero_or_at_least(sy_, 0x1p-40f);
  }

  Sheared operator()(const Vec3& vertex) {
    const Coordinates v = coordinates(vertex);
    const float x = v[kx_] - origin_[kx_], y = v[ky_] - origin_[ky_], z = v[kz_] - origin_[kz_];
    same &= zero_or_at_least(z, 0x1p-60f) & (std::max({std::fabs(x), std::fabs(y), std::fabs(z)}) < 0x1p60f);
    return {x - sx_ * z, y - sy_ * z, z};
  }

  bool same;

 private:
  using Coordinates = std::array<float, 3>;
  static Coordinates coordinates(const Vec3& v) { return {v.x, v.y, v.z}; }
  static bool zero_or_at_least(float x, float least) { return (x == 0) | (std::fabs(x) >= least); }

  std::size_t kx_, ky_, kz_;
  float sx_, sy_;
  Coordinates origin_;
};

}  // namespace

TriangleResult triangle_test(const PreparedRay& ray, const Vec3& v0, const Vec3& v1, const Vec3& v2, float tmax) {
  NarrowShear shear(ray);
  Sheared a = shear(v0), b = shear(v1), c = shear(v2);
  if (!shear.same) [[unlikely]]
    a = shear_wide(ray, v0), b = shear_wide(ray, v1), c = shear_wide(ray, v2);
  const double cxby = c.x * b.y, cybx = c.y * b.x;
  const double axcy = a.x * c.y, aycx = a.y * c.x;
  const double bxay = b.x * a.y, byax = b.y * a.x;
  const bool any_negative = (cxby < cybx) | (axcy < aycx) | (bxay < byax);
  const bool any_positive = (cxby > cybx) | (axcy > aycx) | (bxay > byax);
  if (any_negative == any_positive) return {};  // signs disagree, or all zero: the triangle is seen edge-on

  const double u = round24_difference(cxby, cybx);
  const double v = round24_difference(axcy, aycx);
  const double w = round24_difference(bxay, byax);
  const double det = round24(round24(u + v) + w);
  const double depth = round24(round24(round24(u * a.z) + round24(v * b.z)) + round24(w * c.z));
  const double scaled_det = round24(det * static_cast<double>(ray.ray.direction[ray.kz]));
  const float t = quotient(depth, scaled_det);
  if (!(ray.ray.tmin <= t && t <= tmax)) return {};
  return {true, t, quotient(v, det), quotient(w, det)};
}

}  // namespace ctu::intersect
