// Affine arithmetic on binary32: centre + sum of part[i] e[i], where the noise symbols e[i] are unknown numbers in
// [-1, 1] that forms share. What depends on the same symbols cancels, where intervals would add up.
//
// `error` bounds all that the symbols do not say: the rounding of every operation, and what multiplication makes of
// products of symbols. So the true value lies in centre + sum part[i] e[i] + [-error, error] for the e[i] that it
// belongs to, in exact arithmetic. A form whose numbers have overflowed says nothing: its range is everything.
// Source: Comba and Stolfi, "Affine arithmetic and its applications to computer graphics", 1993; suggested for packets
// by Boulos, Wald, Shirley, section 6.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "model/numeric/interval.h"

namespace ctu::numeric {

template <std::size_t kSymbols>
struct Affine {
  float centre = 0;
  std::array<float, kSymbols> part{};
  float error = 0;

  static Affine point(float x) { return {x, {}, 0}; }
  /// A number of the interval, of which no symbol tells more. The interval is not empty.
  static Affine unrelated(const Interval& x);

  /// How far the form reaches to either side of its centre.
  float radius() const;
  Interval range() const;
};

namespace detail {

/// The sum of bounds that are not negative.
inline float error_sum(float a, float b) {
  OperationMeter::add(1, 0);
  return add<Round::Up>(a, b);
}
inline float error_product(float a, float b) {
  OperationMeter::add(0, 1);
  return bound_product<Round::Up>(a, b);
}

/// A result of one operation, rounded to nearest, and a bound on what the rounding took: between the neighbours that
/// enclose the exact result, so zero where it is exact.
struct Rounded {
  float value, error;
};
inline Rounded rounded_sum(float a, float b) {
  OperationMeter::add(4, 0);
  return {add<Round::Nearest>(a, b), sub<Round::Up>(add<Round::Up>(a, b), add<Round::Down>(a, b))};
}
inline Rounded rounded_product(float a, float b) {
  OperationMeter::add(1, 3);
  return {mul<Round::Nearest>(a, b), sub<Round::Up>(mul<Round::Up>(a, b), mul<Round::Down>(a, b))};
}

}  // namespace detail

/// Some number near the middle of a bounded interval, and how far the interval reaches from it.
struct Middle {
  float centre, radius;
};
inline Middle middle_of(const Interval& x) {
  const float centre = mul<Round::Nearest>(0.5f, x.lo) + mul<Round::Nearest>(0.5f, x.hi);
  OperationMeter::add(3, 2);
  return {centre, max(sub<Round::Up>(x.hi, centre), sub<Round::Up>(centre, x.lo))};
}

template <std::size_t kSymbols>
Affine<kSymbols> Affine<kSymbols>::unrelated(const Interval& x) {
  const Middle middle = middle_of(x);
  return {middle.centre, {}, middle.radius};
}

template <std::size_t kSymbols>
float Affine<kSymbols>::radius() const {
  float sum = error;
  for (const float p : part)
    if (p != 0) sum = detail::error_sum(sum, std::fabs(p));
  return sum;
}

template <std::size_t kSymbols>
Interval Affine<kSymbols>::range() const {
  const float reach = radius();
  if (!std::isfinite(centre) || !std::isfinite(reach)) return Interval::whole();
  OperationMeter::add(2, 0);
  return {sub<Round::Down>(centre, reach), add<Round::Up>(centre, reach)};
}

template <std::size_t kSymbols>
Affine<kSymbols> operator-(const Affine<kSymbols>& a) {
  Affine<kSymbols> result = a;
  result.centre = -a.centre;
  for (float& p : result.part) p = -p;
  return result;
}

template <std::size_t kSymbols>
Affine<kSymbols> operator+(const Affine<kSymbols>& a, const Affine<kSymbols>& b) {
  Affine<kSymbols> result;
  const detail::Rounded centre = detail::rounded_sum(a.centre, b.centre);
  result.centre = centre.value;
  float error = detail::error_sum(detail::error_sum(a.error, b.error), centre.error);
  for (std::size_t i = 0; i < kSymbols; ++i) {
    if (a.part[i] == 0 || b.part[i] == 0) {
      result.part[i] = a.part[i] == 0 ? b.part[i] : a.part[i];
      continue;
    }
    const detail::Rounded part = detail::rounded_sum(a.part[i], b.part[i]);
    result.part[i] = part.value;
    error = detail::error_sum(error, part.error);
  }
  result.error = error;
  return result;
}

template <std::size_t kSymbols>
Affine<kSymbols> operator-(const Affine<kSymbols>& a, const Affine<kSymbols>& b) {
  return a + -b;
}

template <std::size_t kSymbols>
Affine<kSymbols> operator*(const Affine<kSymbols>& a, float s) {
  if (s == 0) return {};
  Affine<kSymbols> result;
  const detail::Rounded centre = detail::rounded_product(a.centre, s);
  result.centre = centre.value;
  float error = detail::error_sum(detail::error_product(a.error, std::fabs(s)), centre.error);
  for (std::size_t i = 0; i < kSymbols; ++i) {
    if (a.part[i] == 0) continue;
    const detail::Rounded part = detail::rounded_product(a.part[i], s);
    result.part[i] = part.value;
    error = detail::error_sum(error, part.error);
  }
  result.error = error;
  return result;
}

/// By a number that is known to lie in the interval: by its middle, and the rest goes to the error.
template <std::size_t kSymbols>
Affine<kSymbols> operator*(const Affine<kSymbols>& a, const Interval& s) {
  if (!s.bounded()) return Affine<kSymbols>::unrelated(Interval::whole());
  const Middle middle = middle_of(s);
  Affine<kSymbols> result = a * middle.centre;
  if (middle.radius != 0) {
    const float largest = detail::error_sum(std::fabs(a.centre), a.radius());
    result.error = detail::error_sum(result.error, detail::error_product(largest, middle.radius));
  }
  return result;
}

/// Plus a number that is known to lie in the interval.
template <std::size_t kSymbols>
Affine<kSymbols> operator+(const Affine<kSymbols>& a, const Interval& s) {
  if (!s.bounded()) return Affine<kSymbols>::unrelated(Interval::whole());
  return a + Affine<kSymbols>::unrelated(s);
}
template <std::size_t kSymbols>
Affine<kSymbols> operator-(const Affine<kSymbols>& a, const Interval& s) {
  return a + -s;
}

/// (ca + La)(cb + Lb) = ca cb + ca Lb + cb La + La Lb, the last bounded by the product of the radii, which hold the
/// errors as well.
template <std::size_t kSymbols>
Affine<kSymbols> operator*(const Affine<kSymbols>& a, const Affine<kSymbols>& b) {
  const Affine<kSymbols> by_centre_of_b = a * b.centre;
  Affine<kSymbols> spread_of_b = b;
  spread_of_b.centre = 0;
  Affine<kSymbols> result = by_centre_of_b + spread_of_b * a.centre;
  result.error = detail::error_sum(result.error, detail::error_product(a.radius(), b.radius()));
  return result;
}

/// Of the form with itself: (c + L)^2 = 2 c (c + L) - c^2 + L^2, and L^2 is not negative.
template <std::size_t kSymbols>
Affine<kSymbols> square(const Affine<kSymbols>& a) {
  const float reach = a.radius();
  const Interval rest = Interval{0, detail::error_product(reach, reach)} - square(Interval::point(a.centre));
  return a * (2 * a.centre) + rest;
}

}  // namespace ctu::numeric
