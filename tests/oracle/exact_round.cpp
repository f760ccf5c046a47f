#include "tests/oracle/exact_round.h"

#include <cmath>

#include "tests/oracle/rational.h"

namespace ctu::oracle {

using numeric::Round;

namespace {

constexpr int kLowestExponent = -149;  // of the last place of subnormal numbers
constexpr int kSignificandBits = 24;

float with_sign(bool negative, std::uint32_t magnitude_bits) {
  return numeric::from_bits(magnitude_bits | (negative ? 0x80000000u : 0u));
}

/// floor(log2(x)) of a positive rational.
long binary_exponent(const Rational& x) {
  const auto bits = [](const mpz_class& n) { return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2)); };
  const long guess = bits(x.get_num()) - bits(x.get_den());
  Rational power(1);
  if (guess >= 0)
    power <<= static_cast<unsigned long>(guess);
  else
    power >>= static_cast<unsigned long>(-guess);
  return x < power ? guess - 1 : guess;
}

Rational times_power_of_two(const Rational& x, long exponent) {
  Rational result;
  if (exponent >= 0)
    mpq_mul_2exp(result.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  else
    mpq_div_2exp(result.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  return result;
}

/// Whether a magnitude between two neighbours goes to the upper one; `half` is 2 x remainder compared with one.
bool goes_up(Round round, bool negative, bool exact, int half, bool lower_is_odd) {
  if (exact) return false;
  if (round == Round::Nearest) return half > 0 || (half == 0 && lower_is_odd);
  return (round == Round::Up) != negative;
}

float zero_sum(Round round, float a, float b) {
  const bool both_negative = std::signbit(a) && std::signbit(b);
  const bool any_negative = std::signbit(a) || std::signbit(b);
  return with_sign(round == Round::Down ? any_negative : both_negative, 0);
}

/// The result where an operand is an infinity or a NaN, or the divisor is zero.
float special(Operation operation, float a, float b) {
  const float nan = numeric::from_bits(numeric::kCanonicalNan);
  const float infinity = std::numeric_limits<float>::infinity();
  if (std::isnan(a) || std::isnan(b)) return nan;
  const bool negative = std::signbit(a) != std::signbit(b);
  switch (operation) {
    case Operation::Sub:
      return special(Operation::Add, a, -b);
    case Operation::Add:
      if (std::isinf(a) && std::isinf(b)) return negative ? nan : a;
      return std::isinf(a) ? a : b;
    case Operation::Mul:
      return a == 0 || b == 0 ? nan : std::copysign(infinity, negative ? -1.0f : 1.0f);
    case Operation::Div:
      if ((std::isinf(a) && std::isinf(b)) || (a == 0 && b == 0)) return nan;
      return std::isinf(b) ? with_sign(negative, 0) : std::copysign(infinity, negative ? -1.0f : 1.0f);
  }
  return nan;
}

}  // namespace

float round_rational(const Rational& x, Round round) {
  const bool negative = x < 0;
  const Rational magnitude = abs(x);
  const long place = std::max<long>(binary_exponent(magnitude) - (kSignificandBits - 1), kLowestExponent);
  Rational scaled = magnitude;
  if (place >= 0)
    scaled >>= static_cast<unsigned long>(place);
  else
    scaled <<= static_cast<unsigned long>(-place);
  mpz_class whole = scaled.get_num() / scaled.get_den();
  const Rational rest = scaled - whole;
  const bool odd = mpz_odd_p(whole.get_mpz_t());
  if (goes_up(round, negative, rest == 0, cmp(rest * 2, Rational(1)), odd)) whole += 1;
  const double result = std::ldexp(whole.get_d(), static_cast<int>(std::min<long>(place, 900)));
  if (result < std::ldexp(1.0, 128)) return static_cast<float>(negative ? -result : result);
  const bool to_infinity = round == Round::Nearest || (round == Round::Up) != negative;
  return with_sign(negative, to_infinity ? 0x7f800000u : 0x7f7fffffu);
}

Rational round24(const Rational& x) {
  if (x == 0) return x;
  // Binary32's rounding, after moving x to about 1.
  const long exponent = binary_exponent(abs(x));
  return times_power_of_two(exact(round_rational(times_power_of_two(x, -exponent), Round::Nearest)), exponent);
}

float quotient_binary32(const Rational& x) { return x == 0 ? 0.0f : round_rational(x, Round::Nearest) + 0.0f; }

float exact_operation(Operation operation, Round round, float a, float b) {
  const bool divides_by_zero = operation == Operation::Div && b == 0;
  if (!std::isfinite(a) || !std::isfinite(b) || divides_by_zero) return special(operation, a, b);
  if (operation == Operation::Sub) return exact_operation(Operation::Add, round, a, -b);
  if (operation == Operation::Add) {
    const Rational sum = exact(a) + exact(b);
    return sum == 0 ? zero_sum(round, a, b) : round_rational(sum, round);
  }
  const Rational result = operation == Operation::Mul ? Rational(exact(a) * exact(b)) : Rational(exact(a) / exact(b));
  return result == 0 ? with_sign(std::signbit(a) != std::signbit(b), 0) : round_rational(result, round);
}

}  // namespace ctu::oracle
