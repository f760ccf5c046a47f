#include "tests/rtl/float/wide_vectors.h"

#include <bit>
#include <cmath>
#include <sstream>

#include "tests/oracle/rational.h"

namespace ctu::rtl {

using oracle::exact;
using oracle::Rational;

namespace {

constexpr int kBias = 1023;
constexpr std::uint32_t kHighestBit = 0x800000;

Wide make_wide(bool negative, int exponent, std::uint32_t significand) {
  return Wide{negative} << 35 | static_cast<Wide>(exponent + kBias) << 24 | significand;
}
int exponent_of(Wide x) { return static_cast<int>(x >> 24 & 0x7ff) - kBias; }
std::uint32_t significand_of(Wide x) { return static_cast<std::uint32_t>(x & 0xffffff); }

/// `x` with another last place or two, as if it had been rounded otherwise.
Wide nudged(Wide x, std::uint64_t by) {
  const std::uint32_t significand = significand_of(x) + static_cast<std::uint32_t>(by % 5) - 2;
  return significand >= kHighestBit && significand < 2 * kHighestBit ? (x & ~Wide{0xffffff}) | significand : x;
}

Rational value(Wide x) {
  if (x == 0) return 0;
  return Rational(std::bit_cast<double>((x >> 24) << 52 | (x & 0x7fffff) << 29));
}

Wide wide(const Rational& x) {
  if (x == 0) return 0;
  const auto bits = std::bit_cast<std::uint64_t>(oracle::round24(x).get_d());
  return (bits >> 52) << 24 | kHighestBit | (bits >> 29 & 0x7fffff);
}

/// A number that rounds as the root of |x| does: the root cut behind 60 bits, and half of its last place more if
/// anything is cut off.
Rational root_bounded(Wide x) {
  if (x == 0) return 0;
  const int exponent = exponent_of(x) - 23, odd = exponent & 1;
  mpz_class radicand(significand_of(x)), root, rest;
  radicand <<= static_cast<unsigned>(96 + odd);
  mpz_sqrtrem(root.get_mpz_t(), rest.get_mpz_t(), radicand.get_mpz_t());
  Rational value = rest == 0 ? Rational(root) : Rational(2 * root + 1, 2);
  const int scale = (exponent - odd) / 2 - 48;
  return scale >= 0 ? Rational(value << static_cast<unsigned>(scale))
                    : Rational(value >> static_cast<unsigned>(-scale));
}

}  // namespace

WideResults exact_results(const WideOperands& o) {
  const Rational a = value(o.a), b = value(o.b), product = a * b;
  return {.converted = wide(exact(o.float_a)),
          .float_difference = wide(exact(o.float_a) - exact(o.float_b)),
          .sum = wide(o.subtract ? Rational(a - b) : Rational(a + b)),
          .product = wide(product),
          .difference = wide(product - value(o.c) * value(o.d)),
          .quotient = numeric::bits(oracle::quotient_binary32(a / b)),
          .ratio = wide(a / b),
          .root = wide(root_bounded(o.a)),
          .narrowed = numeric::bits(oracle::quotient_binary32(a))};
}

std::string first_difference(const WideOperands& o, const WideResults& is, const WideResults& should) {
  std::ostringstream text;
  text << std::hex;
  const auto compare = [&](const char* what, std::uint64_t bits, std::uint64_t right_bits) {
    if (bits != right_bits && text.view().empty())
      text << what << ": 0x" << bits << " should be 0x" << right_bits << "; a 0x" << o.a << " b 0x" << o.b << " c 0x"
           << o.c << " d 0x" << o.d << ", floats 0x" << numeric::bits(o.float_a) << " 0x" << numeric::bits(o.float_b)
           << (o.subtract ? ", subtracted" : ", added");
  };
  compare("converted", is.converted, should.converted);
  compare("float_difference", is.float_difference, should.float_difference);
  compare("sum", is.sum, should.sum);
  compare("product", is.product, should.product);
  compare("difference", is.difference, should.difference);
  compare("quotient", is.quotient, should.quotient);
  compare("ratio", is.ratio, should.ratio);
  compare("root", is.root, should.root);
  compare("narrowed", is.narrowed, should.narrowed);
  return text.str();
}

std::uint32_t HardWideOperands::significand() {
  const auto random = static_cast<std::uint32_t>(bits_());
  const std::uint32_t mask = 0xffffffu << below(24) & 0xffffffu;
  switch (below(4)) {
    case 0:
      return kHighestBit | (random & mask);  // few bits
    case 1:
      return kHighestBit | (0xffffffu & ~(random & ~mask));  // many ones
    default:
      return kHighestBit | (random & 0x7fffffu);
  }
}

Wide HardWideOperands::number(int smallest_exponent, int largest_exponent) {
  if (below(64) == 0) return 0;
  const auto exponents = static_cast<std::uint64_t>(largest_exponent - smallest_exponent + 1);
  return make_wide(below(2) != 0, smallest_exponent + static_cast<int>(below(exponents)), significand());
}

WideOperands HardWideOperands::next() {
  WideOperands o;
  // Anything, or all within reach of each other.
  const int centre = below(2) == 0 ? 0 : static_cast<int>(below(400)) - 200, reach = below(4) == 0 ? 40 : 2;
  for (Wide* x : {&o.a, &o.b, &o.c, &o.d}) *x = number(centre - reach, centre + reach);
  do {
    const numeric::Pair pair = floats_.next();
    o.float_a = pair.first, o.float_b = pair.second;
  } while (!std::isfinite(o.float_a) || !std::isfinite(o.float_b));
  o.subtract = below(2) != 0;
  switch (below(8)) {
    case 0:
      below(2) == 0 ? make_halves(o) : make_almost_half(o);
      break;
    case 1:
    case 2:
      make_cancellation(o);
      break;
    case 3:
      make_equal_products(o);
      break;
    case 4:
    case 5:
      make_extreme_quotient(o);
      break;
    default:
      break;
  }
  if (o.b == 0) o.b = make_wide(false, 0, significand());
  return o;
}

/// A product of 25 bits ends in the middle between two numbers, and so does a sum with a bit just below the last place.
void HardWideOperands::make_halves(WideOperands& o) {
  const int exponent = static_cast<int>(below(200)) - 100, bits = 2 + static_cast<int>(below(22));
  const auto odd = [&](int count) {
    return kHighestBit | ((static_cast<std::uint32_t>(bits_()) | 1) << (24 - count) & 0x7fffffu);
  };
  o.a = make_wide(below(2) != 0, exponent, odd(bits));
  o.b = make_wide(below(2) != 0, exponent, odd(25 - bits + static_cast<int>(below(2))));
  if (below(2) == 0) return;
  o.a = make_wide(below(2) != 0, exponent, significand());
  o.b =
      make_wide(below(2) != 0, exponent - 22 - static_cast<int>(below(5)), below(2) != 0 ? kHighestBit : significand());
}

/// The lower half of the product is one more than the middle between two numbers.
void HardWideOperands::make_almost_half(WideOperands& o) {
  const std::uint32_t odd = significand() | 1;
  std::uint32_t inverse = odd;  // modulo 2^32: each step doubles the places that are right
  for (int i = 0; i < 4; ++i) inverse *= 2 - odd * inverse;
  const std::uint32_t other = inverse * (kHighestBit + 1) & 0xffffffu;
  if (other < kHighestBit) return;
  o.a = make_wide(below(2) != 0, static_cast<int>(below(100)), odd);
  o.b = make_wide(below(2) != 0, static_cast<int>(below(100)), other);
}

void HardWideOperands::make_cancellation(WideOperands& o) {
  o.b = nudged(o.a, below(5));
  if (below(4) == 0)
    o.b = make_wide((o.a >> 35) != 0, exponent_of(o.a) - 1, 0xffffffu - static_cast<std::uint32_t>(below(8)));
  if (o.a == 0) o.b = 0;
  if (below(2) == 0) o.subtract = (o.a >> 35) == (o.b >> 35);
}

/// c d as a b, exactly or but for a few last places: the factors exchanged, or one doubled and the other halved.
void HardWideOperands::make_equal_products(WideOperands& o) {
  o.c = o.b, o.d = o.a;
  const auto by = static_cast<int>(below(5)) - 2;
  if (o.c != 0 && o.d != 0) {
    o.c = make_wide((o.c >> 35) != 0, exponent_of(o.c) + by, significand_of(o.c));
    o.d = make_wide((o.d >> 35) != 0, exponent_of(o.d) - by, significand_of(o.d));
  }
  if (below(2) == 0) o.c = o.c == 0 ? 0 : nudged(o.c, below(5));
  if (below(2) == 0) o.d = o.d == 0 ? 0 : nudged(o.d, below(5));
}

/// About the smallest normal and subnormal quotients and the largest, and far beyond both.
void HardWideOperands::make_extreme_quotient(WideOperands& o) {
  const int ends[] = {-126, -149, 128, -700, 700, -400, 400, -256};
  const int end = ends[below(8)] + static_cast<int>(below(8)) - 4;
  const int exponent = static_cast<int>(below(20)) - 10 - end / 2;
  o.b = make_wide(below(2) != 0, exponent, below(4) == 0 ? kHighestBit : significand());
  o.a = make_wide(below(2) != 0, exponent + end, below(8) == 0 ? significand_of(o.b) : significand());
}

}  // namespace ctu::rtl
