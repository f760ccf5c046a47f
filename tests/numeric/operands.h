// Operands that find rounding mistakes: every class of number, and random ones whose sums, products and quotients
// land where results change kind (cancellation, subnormals, overflow).
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "model/numeric/round.h"

namespace ctu::numeric {

/// All classes of binary32 with the neighbours of their borders, both signs.
inline std::vector<float> corner_operands() {
  const std::uint32_t magnitudes[] = {
      0x00000000, 0x00000001, 0x00000002, 0x00000003, 0x00400000, 0x007ffffe, 0x007fffff,  // zero, subnormals
      0x00800000, 0x00800001, 0x00ffffff, 0x01000000, 0x0c800000, 0x19ffffff, 0x1a3504f3, 0x20000000,  // small
      0x3effffff, 0x3f000000, 0x3f7fffff, 0x3f800000, 0x3f800001, 0x3fc00000, 0x40000000, 0x40400000,  // about one
      0x4b000000, 0x4b7fffff, 0x4b800000, 0x4b800001, 0x5f3504f3, 0x5f7fffff, 0x5f800000,              // large
      0x7e7fffff, 0x7e800000, 0x7effffff, 0x7f000000, 0x7f000001, 0x7f7ffffe, 0x7f7fffff,              // the largest
      0x7f800000, 0x7f800001, 0x7fa12345, 0x7fc00000, 0x7fffffff};  // infinity and NaNs
  std::vector<float> operands;
  for (const std::uint32_t magnitude : magnitudes) {
    operands.push_back(from_bits(magnitude));
    operands.push_back(from_bits(magnitude | 0x80000000u));
  }
  return operands;
}

using Pair = std::pair<float, float>;

class RandomPairs {
 public:
  explicit RandomPairs(std::uint64_t seed) : bits_(seed) {}

  Pair next() {
    const float a = from_bits(word());
    const int exponent = static_cast<int>(bits(a) >> 23 & 0xff);
    switch (word() % 6) {
      case 0:
        return {a, from_bits(word())};
      case 1:
        return {a, with_exponent(exponent + small())};  // sums that cancel, quotients about one
      case 2:
        return {a, with_exponent(127 - 126 - 12 - exponent + 127 + 2 * small())};  // products go subnormal
      case 3:
        return {a, with_exponent(127 + 127 - exponent + 127 + small())};  // products overflow
      case 4:
        return {a, with_exponent(exponent - 127 + small())};  // quotients overflow
      default:
        return {a, with_exponent(exponent + 127 + 12 + 2 * small())};  // quotients go subnormal
    }
  }

 private:
  std::uint32_t word() { return static_cast<std::uint32_t>(bits_()); }
  int small() { return static_cast<int>(word() % 13) - 6; }

  /// Any sign and exponent given; the significand random, all but full or all but empty.
  float with_exponent(int biased) {
    const auto exponent = static_cast<std::uint32_t>(biased < 0 ? 0 : biased > 254 ? 254 : biased);
    std::uint32_t significand = word() & 0x7fffffu;
    const std::uint32_t shape = word() % 4;
    if (shape == 0) significand &= 7u;
    if (shape == 1) significand |= 0x7ffff8u;
    return from_bits((word() & 0x80000000u) | exponent << 23 | significand);
  }

  std::mt19937_64 bits_;
};

inline std::vector<Pair> operand_pairs(std::uint64_t seed, int random_count) {
  std::vector<Pair> pairs;
  const std::vector<float> corners = corner_operands();
  for (const float a : corners) {
    for (const float b : corners) pairs.emplace_back(a, b);
  }
  RandomPairs random(seed);
  for (int i = 0; i < random_count; ++i) pairs.push_back(random.next());
  return pairs;
}

}  // namespace ctu::numeric
