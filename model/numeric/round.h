// The one arithmetic of the unit (contract 2): binary32 with the rounding direction in the type.
//
// Rules, the same in reference, SystemC and Verilog:
//   subnormals  are operands and results like any other number (no flush to zero)
//   zero        x - x is +0 under Nearest and Up, -0 under Down; signs of products and quotients as IEEE 754
//   infinity    overflow gives the infinity or the largest finite number, as the direction says
//   NaN         every invalid operation gives the one quiet NaN 0x7fc00000; NaN operands give it too
//   min, max    of a NaN and a number: the number; -0 orders before +0
//   comparisons with a NaN are false
// Results equal IEEE 754 in the same rounding direction, bit for bit. Nothing here touches the
// processor's rounding mode: directed results come from the nearest one and its exact error.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace ctu::numeric {

enum class Round : std::uint8_t { Nearest, Down, Up };

inline constexpr std::uint32_t kCanonicalNan = 0x7fc00000u;

inline std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }
inline float from_bits(std::uint32_t b) { return std::bit_cast<float>(b); }

/// The neighbours on the binary32 line: -inf .. -0,+0 .. +inf. next_up(-0) and next_up(+0) are the
/// smallest subnormal; next_up(+inf) is +inf; next_up(-inf) is the lowest finite number.
float next_up(float x);
float next_down(float x);

template <Round M>
float add(float a, float b);
template <Round M>
float sub(float a, float b);
template <Round M>
float mul(float a, float b);
template <Round M>
float div(float a, float b);
float min(float a, float b);
float max(float a, float b);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

inline float canonical(float x) { return x == x ? x : from_bits(kCanonicalNan); }

/// From the nearest result and where the exact one lies, the directed result. Overflow needs no case of its own:
/// the neighbour of an infinity is the largest finite number.
template <Round M>
float directed(float nearest, bool exact_is_below, bool exact_is_above) {
  if constexpr (M == Round::Down) return canonical(exact_is_below ? next_down(nearest) : nearest);
  if constexpr (M == Round::Up) return canonical(exact_is_above ? next_up(nearest) : nearest);
  return canonical(nearest);
}

}  // namespace detail

inline float next_up(float x) {
  if (!(x < std::numeric_limits<float>::infinity())) return detail::canonical(x);
  if (x == 0) return from_bits(1);
  return from_bits(x > 0 ? bits(x) + 1 : bits(x) - 1);
}

inline float next_down(float x) {
  if (!(x > -std::numeric_limits<float>::infinity())) return detail::canonical(x);
  if (x == 0) return from_bits(0x80000001u);
  return from_bits(x > 0 ? bits(x) - 1 : bits(x) + 1);
}

/// The sum in binary64 rounds once more than binary32 can see, so its own error (Knuth's TwoSum, exact: binary64
/// cannot overflow here) decides when it falls on a binary32 number.
template <Round M>
float add(float a, float b) {
  const float nearest = a + b;
  if constexpr (M == Round::Nearest) return detail::canonical(nearest);
  if constexpr (M == Round::Down) {
    if (nearest == 0) return from_bits((bits(a) | bits(b)) & 0x80000000u);  // a zero sum is exact: +0 only of two +0
  }
  const double wide_a = a, wide_b = b, wide_nearest = nearest;
  const double sum = wide_a + wide_b;
  const double rest_b = sum - wide_a;
  const double error = (wide_a - (sum - rest_b)) + (wide_b - rest_b);
  const bool on_number = sum == wide_nearest;
  return detail::directed<M>(nearest, sum < wide_nearest || (on_number && error < 0),
                             sum > wide_nearest || (on_number && error > 0));
}

template <Round M>
float sub(float a, float b) {
  return add<M>(a, from_bits(bits(b) ^ 0x80000000u));
}

/// The product of two 24-bit significands is exact in binary64, and its exponent is in range.
template <Round M>
float mul(float a, float b) {
  const double exact = static_cast<double>(a) * static_cast<double>(b);
  const float nearest = static_cast<float>(exact);
  return detail::directed<M>(nearest, exact<nearest, exact> nearest);
}

/// The sign of the remainder a - q b says on which side of q the exact quotient lies; q b is exact in binary64.
/// Quotients by zero or infinity are exact: there q b is a NaN or equals a, and nothing moves.
template <Round M>
float div(float a, float b) {
  const float nearest = a / b;
  const double back = static_cast<double>(nearest) * static_cast<double>(b);
  const bool remainder_below = a<back, remainder_above = a> back;
  return detail::directed<M>(nearest, b > 0 ? remainder_below : remainder_above,
                             b > 0 ? remainder_above : remainder_below);
}

inline float min(float a, float b) {
  if (!(b == b)) return detail::canonical(a);
  if (a == b) return from_bits(bits(a) | bits(b));  // differ in the sign of zero at most
  return b < a || !(a == a) ? b : a;
}

inline float max(float a, float b) {
  if (!(b == b)) return detail::canonical(a);
  if (a == b) return from_bits(bits(a) & bits(b));
  return b > a || !(a == a) ? b : a;
}

}  // namespace ctu::numeric
