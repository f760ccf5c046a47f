// Numbers inside the primitive tests: binary32's 24-bit significand with an exponent wide enough (11 bits) never to
// leave its range. They are kept in binary64, where one operation on two of them rounds to 53 bits; a second rounding
// to 24 then gives what one rounding of the exact result would, for sums, products, quotients and square roots
// (Figueroa 1995: 53 >= 2 * 24 + 2).
#pragma once

#include <bit>
#include <cstdint>

namespace ctu::intersect {

/// Round to nearest even at 24 significant bits, the exponent kept as it is. Carries run into the exponent rightly.
inline double round24(double x) {
  constexpr std::uint64_t kDropped = (std::uint64_t{1} << 29) - 1;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t even = (bits >> 29) & 1;
  return std::bit_cast<double>((bits + (kDropped >> 1) + even) & ~kDropped);
}

}  // namespace ctu::intersect
