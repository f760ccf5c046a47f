#include "tests/rtl/float/float_vectors.h"

namespace ctu::rtl {

using numeric::bits;
using numeric::from_bits;
using numeric::Pair;

namespace {

/// Powers of two, subnormal ones included, with the numbers on both sides.
std::vector<float> powers_of_two() {
  std::vector<float> operands;
  const auto add = [&](std::uint32_t power) {
    for (const std::uint32_t magnitude : {power - 1, power, power + 1}) {
      operands.push_back(from_bits(magnitude));
      operands.push_back(from_bits(magnitude | 0x80000000u));
    }
  };
  for (std::uint32_t place = 1; place < 23; ++place) add(1u << place);
  for (std::uint32_t exponent = 1; exponent < 255; ++exponent) add(exponent << 23);
  return operands;
}

}  // namespace

std::vector<Pair> corner_pairs() {
  const std::vector<float> corners = numeric::corner_operands(), powers = powers_of_two();
  std::vector<Pair> pairs = numeric::operand_pairs(0, 0);
  for (const float power : powers) {
    for (const float corner : corners) {
      pairs.emplace_back(power, corner);
      pairs.emplace_back(corner, power);
    }
    for (const float other : powers) pairs.emplace_back(power, other);
  }
  return pairs;
}

Pair HardPairs::next() {
  switch (bits_() % 8) {
    case 0:
      return half_product();
    case 1:
      return half_sum();
    case 2:
      return near_cancellation();
    case 3:
      return near_corners();
    default:
      return general_.next();
  }
}

void HardPairs::fill(std::vector<Pair>& pairs, std::size_t count) {
  pairs.resize(count);
  for (Pair& pair : pairs) pair = next();
}

/// 13 by 12 odd bits give 24 or 25 bits: half of these products lie exactly between two numbers. The exponents add up
/// to any place, most of them in or near the subnormal range.
Pair HardPairs::half_product() {
  const std::uint64_t word = bits_();
  const auto wide = static_cast<std::uint32_t>(word >> 3 & 0x7ff) << 12 | 1u << 11;
  const auto narrow = static_cast<std::uint32_t>(word >> 14 & 0x3ff) << 13 | 1u << 12;
  const auto exponent = static_cast<std::uint32_t>(1 + (word >> 24 & 0xff) % 254);
  const std::uint32_t near_end = 127 - 26 + static_cast<std::uint32_t>(word >> 32 & 31);
  const bool at_end = (word >> 40 & 3) != 0 && exponent < near_end;
  const std::uint32_t other = at_end ? near_end - exponent : static_cast<std::uint32_t>(1 + (word >> 48 & 0xff) % 254);
  return {from_bits(static_cast<std::uint32_t>(word & 1) << 31 | exponent << 23 | wide),
          from_bits(static_cast<std::uint32_t>(word >> 1 & 1) << 31 | (other ? other : 1) << 23 | narrow)};
}

/// A number and half of its last place, or a neighbour of that half.
Pair HardPairs::half_sum() {
  const std::uint64_t word = bits_();
  const auto exponent = static_cast<std::uint32_t>(1 + (word >> 8 & 0xff) % 254);
  const auto magnitude = exponent << 23 | static_cast<std::uint32_t>(word >> 40);
  const std::uint32_t below = 22 + static_cast<std::uint32_t>(word >> 16 & 3);
  std::uint32_t half = exponent > below ? (exponent - below) << 23 : 1u << (word >> 18 & 15) % 23;
  half += static_cast<std::uint32_t>(word >> 24 & 3) - 1;
  const float large = from_bits((magnitude & 0x7fffffffu) | static_cast<std::uint32_t>(word & 1) << 31);
  const float small = from_bits((half & 0x7fffffffu) | static_cast<std::uint32_t>(word >> 1 & 1) << 31);
  return word & 4 ? Pair{large, small} : Pair{small, large};
}

/// Two numbers a few places apart, of any signs.
Pair HardPairs::near_cancellation() {
  const std::uint64_t word = bits_();
  const auto a = static_cast<std::uint32_t>(word);
  const auto apart = static_cast<std::uint32_t>(word >> 32 & 15) - 7;
  const auto magnitude = (a & 0x7fffffffu) + ((word >> 36 & 1) != 0 ? apart : 0);
  return {from_bits(a), from_bits((magnitude & 0x7fffffffu) | static_cast<std::uint32_t>(word >> 37 & 1) << 31)};
}

/// Two corners, each moved by a few places.
Pair HardPairs::near_corners() {
  const std::uint64_t word = bits_();
  const auto moved = [&](unsigned from) {
    const float corner = corners_[(word >> from & 0xffff) % corners_.size()];
    return from_bits(bits(corner) + static_cast<std::uint32_t>(word >> (from + 16) & 7) - 3);
  };
  return {moved(0), moved(32)};
}

}  // namespace ctu::rtl
