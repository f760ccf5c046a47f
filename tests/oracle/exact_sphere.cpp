#include "tests/oracle/exact_sphere.h"

#include <cstdint>
#include <limits>

#include "tests/oracle/rational.h"

namespace ctu::oracle {

namespace {

/// |o + t d - c|^2 - r^2 = a t^2 + 2 b t + c, whose two zeros, if it has any, lie on both sides of `vertex`.
class Quadratic {
 public:
  Quadratic(const intersect::Ray& ray, const Vec3& centre, float radius) {
    const Vec3q d = exact(ray.direction), from_centre = exact(ray.origin) - exact(centre);
    a_ = dot(d, d);
    b_ = dot(from_centre, d);
    c_ = dot(from_centre, from_centre) - exact(radius) * exact(radius);
    vertex_ = -b_ / a_;
  }

  bool has_zeros() const { return b_ * b_ >= a_ * c_; }

  /// Whether the first or second zero is at or before t.
  bool zero_by(bool second, const Rational& t) const {
    return second ? t >= vertex_ && value(t) >= 0 : t >= vertex_ || value(t) <= 0;
  }
  bool zero_before(bool second, const Rational& t) const {
    return second ? t > vertex_ && value(t) > 0 : t > vertex_ || value(t) < 0;
  }

 private:
  Rational value(const Rational& t) const { return (a_ * t + 2 * b_) * t + c_; }

  Rational a_, b_, c_, vertex_;
};

/// Binary32 numbers without NaN, counted from the lowest finite one; 0 and -0 are one number.
constexpr std::int64_t kLargest = 0x7f7fffff;

float number_of(std::int64_t rank) {
  return rank >= 0 ? numeric::from_bits(static_cast<std::uint32_t>(rank))
                   : -numeric::from_bits(static_cast<std::uint32_t>(-rank));
}

/// The zero between the binary32 numbers that enclose it most tightly.
ExactTime enclose_zero(const Quadratic& quadratic, bool second) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::int64_t before = -kLargest - 1, by = kLargest + 1;  // the infinities
  while (by - before > 1) {
    const std::int64_t middle = before + (by - before) / 2;
    (quadratic.zero_by(second, exact(number_of(middle))) ? by : before) = middle;
  }
  if (by > kLargest) return {number_of(kLargest), kInfinity};
  const float up = number_of(by);
  if (!quadratic.zero_before(second, exact(up))) return {up, up};
  return {before < -kLargest ? -kInfinity : number_of(before), up};
}

}  // namespace

ExactSphereHit exact_ray_sphere(const intersect::Ray& ray, const Vec3& centre, float radius, float tmin, float tmax) {
  const Quadratic quadratic(ray, centre, radius);
  if (!quadratic.has_zeros() || !(tmin <= tmax)) return {};
  for (const bool second : {false, true}) {
    if (tmin > -std::numeric_limits<float>::infinity() && quadratic.zero_before(second, exact(tmin))) continue;
    if (tmax < std::numeric_limits<float>::infinity() && !quadratic.zero_by(second, exact(tmax))) continue;
    return {true, enclose_zero(quadratic, second)};
  }
  return {};
}

}  // namespace ctu::oracle
