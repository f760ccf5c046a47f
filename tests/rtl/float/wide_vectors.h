// Operands for the wide units (rtl/float/wide_format.svh), and what the units must make of them, in rationals.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "tests/rtl/float/float_vectors.h"

namespace ctu::rtl {

/// A wide number's 36 bits.
using Wide = std::uint64_t;

struct WideOperands {
  Wide a = 0, b = 1, c = 0, d = 0;  ///< b is not zero
  float float_a = 0, float_b = 0;   ///< finite
  bool subtract = false;
};

struct WideResults {
  Wide converted = 0, float_difference = 0, sum = 0, product = 0, difference = 0;
  std::uint32_t quotient = 0;
  Wide ratio = 0, root = 0;  ///< a / b, and the root of |a|
  std::uint32_t narrowed = 0;
};

/// Every rounding of an exact value by oracle::round24 and oracle::quotient_binary32.
WideResults exact_results(const WideOperands& operands);

/// The first unit whose bits differ, with operands and both results; empty if none does.
std::string first_difference(const WideOperands& operands, const WideResults& is, const WideResults& should);

/// Random operands where hardware goes wrong: exact halves, cancellation to a few bits and to zero, operands just out
/// of each other's reach, quotients at both ends of binary32, few and many significant bits, zeros.
class HardWideOperands {
 public:
  explicit HardWideOperands(std::uint64_t seed) : floats_(seed ^ 0x51a7u), bits_(seed) {}
  WideOperands next();

 private:
  std::uint64_t below(std::uint64_t count) { return bits_() % count; }
  std::uint32_t significand();
  Wide number(int smallest_exponent, int largest_exponent);
  void make_halves(WideOperands& o);
  void make_almost_half(WideOperands& o);
  void make_cancellation(WideOperands& o);
  void make_equal_products(WideOperands& o);
  void make_extreme_quotient(WideOperands& o);

  HardPairs floats_;
  std::mt19937_64 bits_;
};

}  // namespace ctu::rtl
