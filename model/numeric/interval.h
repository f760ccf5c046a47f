// Interval arithmetic on binary32 with outward rounding: whatever real numbers the operands hold, the result holds
// what the exact operation makes of them.
//
// An interval is a set of finite real numbers. An infinite bound says that none is known on that side; so zero times
// an unbounded interval is zero, and no operation on intervals that are not empty gives a NaN. An interval with
// lo > hi is empty: it may be made and asked, not computed with.
// Source: Boulos, Wald, Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray Packets", section 2.2.
#pragma once

#include <cmath>
#include <limits>

#include "model/numeric/operation_meter.h"
#include "model/numeric/round.h"

namespace ctu::numeric {

struct Interval {
  float lo = 0, hi = 0;

  static Interval point(float x) { return {x, x}; }
  static Interval whole() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return {-kInfinity, kInfinity};
  }
  /// Holds nothing; united with an interval it gives that one.
  static Interval nothing() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return {kInfinity, -kInfinity};
  }

  bool empty() const { return !(lo <= hi); }
  bool holds(float x) const { return lo <= x && x <= hi; }
  bool positive() const { return lo > 0; }
  bool negative() const { return hi < 0; }
  bool is_zero() const { return lo == 0 && hi == 0; }
  bool bounded() const { return std::isfinite(lo) && std::isfinite(hi); }
  bool operator==(const Interval&) const = default;
};

inline Interval unite(const Interval& a, const Interval& b) { return {min(a.lo, b.lo), max(a.hi, b.hi)}; }
/// What is in both; may be empty.
inline Interval overlap(const Interval& a, const Interval& b) { return {max(a.lo, b.lo), min(a.hi, b.hi)}; }
/// Every number of `part` is one of `whole`.
inline bool within(const Interval& part, const Interval& whole) { return whole.lo <= part.lo && part.hi <= whole.hi; }

inline Interval operator-(const Interval& a) { return {-a.hi, -a.lo}; }

inline Interval operator+(const Interval& a, const Interval& b) {
  OperationMeter::add(2, 0);
  return {add<Round::Down>(a.lo, b.lo), add<Round::Up>(a.hi, b.hi)};
}
inline Interval operator-(const Interval& a, const Interval& b) {
  OperationMeter::add(2, 0);
  return {sub<Round::Down>(a.lo, b.hi), sub<Round::Up>(a.hi, b.lo)};
}
/// The difference of two binary32 numbers, enclosed as tightly as can be.
inline Interval difference(float a, float b) {
  OperationMeter::add(2, 0);
  return {sub<Round::Down>(a, b), sub<Round::Up>(a, b)};
}

namespace detail {

/// Products of bounds: zero times unbounded is zero.
template <Round M>
float bound_product(float a, float b) {
  return a == 0 || b == 0 ? 0 : mul<M>(a, b);
}
inline Interval products(float lo_a, float lo_b, float hi_a, float hi_b) {
  OperationMeter::add(0, 2);
  return {bound_product<Round::Down>(lo_a, lo_b), bound_product<Round::Up>(hi_a, hi_b)};
}

}  // namespace detail

/// The signs say which two of the four products of bounds are the least and the greatest; only where both operands
/// hold numbers of both signs are all four needed.
inline Interval operator*(const Interval& a, const Interval& b) {
  if (a.lo >= 0) return detail::products(b.lo >= 0 ? a.lo : a.hi, b.lo, b.hi >= 0 ? a.hi : a.lo, b.hi);
  if (a.hi <= 0) return detail::products(b.hi >= 0 ? a.lo : a.hi, b.hi, b.lo >= 0 ? a.hi : a.lo, b.lo);
  if (b.lo >= 0) return detail::products(a.lo, b.hi, a.hi, b.hi);
  if (b.hi <= 0) return detail::products(a.hi, b.lo, a.lo, b.lo);
  const Interval crossed = detail::products(a.lo, b.hi, a.lo, b.lo),
                 straight = detail::products(a.hi, b.lo, a.hi, b.hi);
  return unite(crossed, straight);
}

/// Tighter than a * a, which does not know that its operands are the same number.
inline Interval square(const Interval& a) {
  if (a.lo >= 0 || a.hi <= 0) return a * a;
  const float largest = max(-a.lo, a.hi);
  OperationMeter::add(0, 1);
  return {0, mul<Round::Up>(largest, largest)};
}

/// All real numbers where `a` holds zero.
inline Interval reciprocal(const Interval& a) {
  if (a.holds(0)) return Interval::whole();
  OperationMeter::add(0, 0, 2);
  return {div<Round::Down>(1, a.hi), div<Round::Up>(1, a.lo)};
}

/// Tighter by a rounding than a * reciprocal(b); all real numbers where `b` holds zero.
inline Interval operator/(const Interval& a, const Interval& b) {
  if (b.holds(0)) return Interval::whole();
  if (b.hi < 0) return -a / -b;
  OperationMeter::add(0, 0, 2);
  const auto down = [](float x, float y) { return x == 0 ? 0 : div<Round::Down>(x, y); };
  const auto up = [](float x, float y) { return x == 0 ? 0 : div<Round::Up>(x, y); };
  const float lo = std::isinf(a.lo) ? a.lo : down(a.lo, a.lo >= 0 ? b.hi : b.lo);
  const float hi = std::isinf(a.hi) ? a.hi : up(a.hi, a.hi >= 0 ? b.lo : b.hi);
  return {lo, hi};
}

/// Of a number that is not negative. A root's square has 48 bits and is exact in binary64, so it says on which side
/// of the exact root the nearest binary32 number lies.
template <Round M>
float root(float x) {
  const float nearest = std::sqrt(x);
  const double squared = static_cast<double>(nearest) * static_cast<double>(nearest);
  return detail::directed<M>(nearest, x<squared, x> squared);
}

/// Of the numbers in `a` that are not negative; `a` holds one.
inline Interval root(const Interval& a) {
  OperationMeter::add(0, 0, 2);
  return {a.lo > 0 ? root<Round::Down>(a.lo) : 0, root<Round::Up>(a.hi)};
}

}  // namespace ctu::numeric
