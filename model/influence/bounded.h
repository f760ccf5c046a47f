// Binary64 numbers with a bound on how far they are off: |exact - value| <= error, whatever was rounded on the way.
// With it a test says "certainly" or "perhaps", and never a wrong "certainly".
//
// Each operation adds its own rounding to what its operands bring: 2^-53 of the result, doubled to cover the rounding
// of the bound itself, a sum of a few numbers that are not negative. Numbers that began as binary32 and were multiplied
// at most six deep, as in a projection on a product of two edges, stay below 2^790: nothing overflows. What a product
// may lose below binary64's normal numbers is covered by kTiny.
#pragma once

#include <cmath>

namespace ctu::influence {

struct Bounded {
  double value = 0, error = 0;

  static constexpr double kUnit = 0x1p-52;
  static constexpr double kTiny = 0x1p-1020;

  Bounded() = default;
  Bounded(double exact) : value(exact) {}
  Bounded(double nearest, double bound) : value(nearest), error(bound) {}

  /// At or below the exact number, at or above it.
  double lower() const { return value - outward(); }
  double upper() const { return value + outward(); }

 private:
  double outward() const { return error == 0 ? 0 : error + (std::fabs(value) + error) * kUnit; }
};

namespace detail {

inline Bounded rounded(double value, double carried) {
  return {value, (carried + std::fabs(value) * Bounded::kUnit) * (1 + 4 * Bounded::kUnit)};
}

}  // namespace detail

inline Bounded operator+(const Bounded& a, const Bounded& b) {
  return detail::rounded(a.value + b.value, a.error + b.error);
}
inline Bounded operator-(const Bounded& a, const Bounded& b) {
  return detail::rounded(a.value - b.value, a.error + b.error);
}
inline Bounded operator*(const Bounded& a, const Bounded& b) {
  const double carried = std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error;
  return detail::rounded(a.value * b.value, carried + Bounded::kTiny);
}

}  // namespace ctu::influence
