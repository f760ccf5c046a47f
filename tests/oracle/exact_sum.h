// The sign of a sum of products, exactly and without rationals: floating-point expansions in binary64 (Shewchuk 1997,
// "Adaptive Precision Floating-Point Arithmetic", grow-expansion with zeros taken out). Simple numbers cost little.
//
// Products of up to four binary32 numbers are exact as two binary64 numbers: their exponents lie in [-596, 512], so
// nothing overflows and no low part underflows.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace ctu::oracle {

class ExactSum {
 public:
  static constexpr std::size_t kMaxTerms = 192;

  void add(double x) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = x + part_[i];
      const double from_part = sum - x;
      const double rest = (x - (sum - from_part)) + (part_[i] - from_part);
      if (rest != 0) part_[kept++] = rest;
      x = sum;
    }
    if (x != 0) part_[kept++] = x;
    size_ = kept;
  }
  /// x y, where both are exact and their product fits two binary64 numbers.
  void add_product(double x, double y) {
    const double high = x * y;
    const double low = std::fma(x, y, -high);
    if (low != 0) add(low);
    if (high != 0) add(high);
  }
  /// -1, 0 or +1: that of the largest part, as parts do not overlap.
  int sign() const { return size_ == 0 ? 0 : part_[size_ - 1] > 0 ? 1 : -1; }

 private:
  std::array<double, kMaxTerms> part_;
  std::size_t size_ = 0;
};

}  // namespace ctu::oracle
