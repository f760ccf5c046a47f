// Operands for the float units: all pairs of corners, and random ones that lie where hardware goes wrong.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "tests/numeric/operands.h"

namespace ctu::rtl {

/// Every corner with every corner, every corner with every power of two and its neighbours (both orders), and every
/// two of these powers. All classes of numbers meet all classes, with both signs.
std::vector<numeric::Pair> corner_pairs();

/// One half tests/numeric's random pairs (uniform bits, close exponents, products at the ends of the range), an eighth
/// each of products and of sums that lie exactly between two numbers, of near-cancellation, and of corners'
/// surroundings.
class HardPairs {
 public:
  explicit HardPairs(std::uint64_t seed)
      : general_(seed), bits_(seed ^ 0x9e3779b97f4a7c15u), corners_(numeric::corner_operands()) {}
  numeric::Pair next();
  /// The next `count` pairs, in place of what `pairs` held.
  void fill(std::vector<numeric::Pair>& pairs, std::size_t count);

 private:
  numeric::Pair half_product();
  numeric::Pair half_sum();
  numeric::Pair near_cancellation();
  numeric::Pair near_corners();

  numeric::RandomPairs general_;
  std::mt19937_64 bits_;
  std::vector<float> corners_;
};

}  // namespace ctu::rtl
