// Interval and affine arithmetic against rationals: what the operands hold, the result holds.
#include "model/numeric/interval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "model/numeric/affine.h"
#include "model/numeric/interval_vector.h"
#include "tests/oracle/rational.h"
#include "tests/oracle/seed.h"

namespace {

using namespace ctu;
using numeric::Affine;
using numeric::Interval;
using oracle::Rational;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Numbers of all sizes, small whole numbers and zeros among them.
class Numbers {
 public:
  explicit Numbers(std::uint64_t salt) : random_(oracle::test_seed() + salt) {}

  float next() {
    switch (random_() % 8) {
      case 0:
        return static_cast<float>(static_cast<int>(random_() % 9) - 4);
      case 1:
        return any();
      default: {
        const float sign = (random_() & 1) != 0 ? 1.0f : -1.0f;
        return sign *
               std::ldexp(static_cast<float>(0x800000 + random_() % 0x800000), static_cast<int>(random_() % 60) - 52);
      }
    }
  }
  Interval interval() {
    const float a = next(), b = random_() % 4 == 0 ? a : next();
    return {std::min(a, b), std::max(a, b)};
  }
  /// A number of the interval, its ends among them, and often one that is no binary32 number.
  Rational member(const Interval& x) {
    const Rational share = Rational(random_() % 9) / 8;
    return oracle::exact(x.lo) * (1 - share) + oracle::exact(x.hi) * share;
  }
  /// In [-1, 1].
  Rational symbol() { return Rational(static_cast<long>(random_() % 17) - 8) / 8; }
  std::uint64_t operator()() { return random_(); }

 private:
  /// Any bits that are a finite number.
  float any() {
    for (;;) {
      const float x = numeric::from_bits(static_cast<std::uint32_t>(random_()));
      if (std::isfinite(x)) return x;
    }
  }
  std::mt19937_64 random_;
};

bool holds(const Interval& x, const Rational& value) {
  const bool above = x.lo == -kInfinity || (std::isfinite(x.lo) && oracle::exact(x.lo) <= value);
  const bool below = x.hi == kInfinity || (std::isfinite(x.hi) && value <= oracle::exact(x.hi));
  return above && below;
}

std::string show(const Interval& x) { return testing::PrintToString(x.lo) + " .. " + testing::PrintToString(x.hi); }

TEST(Interval, results_hold_what_the_exact_operation_makes_of_members) {
  SCOPED_TRACE(oracle::seed_note());
  Numbers numbers(1);
  for (int i = 0; i < 40000; ++i) {
    const Interval a = numbers.interval(), b = numbers.interval();
    const Rational x = numbers.member(a), y = numbers.member(b);
    SCOPED_TRACE(show(a) + " and " + show(b));
    ASSERT_TRUE(holds(a + b, x + y));
    ASSERT_TRUE(holds(a - b, x - y));
    ASSERT_TRUE(holds(a * b, x * y));
    ASSERT_TRUE(holds(-a, -x));
    ASSERT_TRUE(holds(square(a), x * x));
    if (y != 0) {
      ASSERT_TRUE(holds(a / b, x / y));
      ASSERT_TRUE(holds(reciprocal(b), 1 / y));
    }
    if (a.hi >= 0 && x >= 0) {
      const Interval root = numeric::root(a);
      ASSERT_GE(root.lo, 0);
      ASSERT_LE(oracle::exact(root.lo) * oracle::exact(root.lo), x);
      ASSERT_TRUE(root.hi == kInfinity || oracle::exact(root.hi) * oracle::exact(root.hi) >= x);
    }
  }
}

TEST(Interval, products_are_no_wider_than_the_directed_products_of_their_bounds) {
  SCOPED_TRACE(oracle::seed_note());
  Numbers numbers(2);
  for (int i = 0; i < 40000; ++i) {
    const Interval a = numbers.interval(), b = numbers.interval();
    float lo = kInfinity, hi = -kInfinity;
    for (const float x : {a.lo, a.hi})
      for (const float y : {b.lo, b.hi}) {
        lo = std::min(lo, numeric::mul<numeric::Round::Down>(x, y));
        hi = std::max(hi, numeric::mul<numeric::Round::Up>(x, y));
      }
    SCOPED_TRACE(show(a) + " and " + show(b));
    ASSERT_EQ((a * b).lo, lo);
    ASSERT_EQ((a * b).hi, hi);
  }
}

TEST(Interval, no_bound_is_ever_a_nan) {
  SCOPED_TRACE(oracle::seed_note());
  const Interval some[] = {Interval::whole(), {0, kInfinity},     {-kInfinity, 0}, {-kInfinity, -2},
                           {3, kInfinity},    Interval::point(0), {-1, 2},         {1e38f, 3e38f},
                           {-3e38f, 3e38f},   {1e-45f, 1e-40f},   {0.0f, 3.4e38f}};
  for (const Interval& a : some)
    for (const Interval& b : some)
      for (const Interval& result :
           {a + b, a - b, a * b, a / b, -a, square(a), reciprocal(a), numeric::root(square(a))}) {
        ASSERT_FALSE(std::isnan(result.lo) || std::isnan(result.hi)) << show(a) << " and " << show(b);
        ASSERT_LE(result.lo, result.hi) << show(a) << " and " << show(b);
      }
}

// Section 3 of the packet culling paper: 1/2 and 2/4 are one point, [1,2] [2,4]^-1 is not.
TEST(Interval, a_quotient_of_intervals_is_wider_than_an_interval_of_quotients) {
  EXPECT_EQ((Interval{1, 2} * reciprocal(Interval{2, 4})), (Interval{0.25f, 1}));
  EXPECT_EQ(unite(Interval::point(1) / Interval::point(2), Interval::point(2) / Interval::point(4)),
            Interval::point(0.5f));
}

TEST(Interval, operations_are_counted_while_a_meter_lives) {
  numeric::OperationCounts counts;
  {
    const numeric::OperationMeter meter(counts);
    EXPECT_EQ((Interval{1, 2} * Interval{3, 4} + Interval{5, 6}), (Interval{8, 14}));
  }
  EXPECT_EQ((Interval{1, 2} * Interval{3, 4}), (Interval{3, 8}));
  EXPECT_EQ(counts.multiplications, 2u);
  EXPECT_EQ(counts.additions, 2u);
  EXPECT_EQ(counts.divisions, 0u);
}

using Form = Affine<3>;

/// What the form says for some values of the symbols, without its error.
Rational at(const Form& form, const Rational (&e)[3]) {
  Rational value = oracle::exact(form.centre);
  for (std::size_t i = 0; i < 3; ++i) value += oracle::exact(form.part[i]) * e[i];
  return value;
}

bool says(const Form& form, const Rational (&e)[3], const Rational& value) {
  if (!std::isfinite(form.centre) || !std::isfinite(form.radius())) return true;
  return abs(value - at(form, e)) <= oracle::exact(form.error) && holds(form.range(), value);
}

Form random_form(Numbers& numbers) {
  Form form = Form::point(numbers.next());
  for (float& part : form.part) part = numbers() % 3 == 0 ? 0 : numbers.next();
  form.error = numbers() % 2 == 0 ? 0 : std::fabs(numbers.next());
  return form;
}

TEST(Affine, results_hold_for_every_choice_of_symbols_and_errors) {
  SCOPED_TRACE(oracle::seed_note());
  Numbers numbers(3);
  for (int i = 0; i < 20000; ++i) {
    const Form a = random_form(numbers), b = random_form(numbers);
    const Rational e[3] = {numbers.symbol(), numbers.symbol(), numbers.symbol()};
    const Rational x = at(a, e) + oracle::exact(a.error) * numbers.symbol();
    const Rational y = at(b, e) + oracle::exact(b.error) * numbers.symbol();
    const Interval s = numbers.interval();
    const Rational z = numbers.member(s);
    ASSERT_TRUE(says(a + b, e, x + y)) << i;
    ASSERT_TRUE(says(a - b, e, x - y)) << i;
    ASSERT_TRUE(says(a * b, e, x * y)) << i;
    ASSERT_TRUE(says(square(a), e, x * x)) << i;
    ASSERT_TRUE(says(a * s.lo, e, x * oracle::exact(s.lo))) << i;
    ASSERT_TRUE(says(a * s, e, x * z)) << i;
    ASSERT_TRUE(says(a + s, e, x + z)) << i;
    ASSERT_TRUE(says(-a, e, -x)) << i;
  }
}

TEST(Affine, what_depends_on_the_same_symbol_cancels) {
  Form a = Form::point(4);
  a.part[1] = 2;
  EXPECT_EQ((a - a).range(), Interval::point(0));
  EXPECT_EQ(a.range() - a.range(), (Interval{-4, 4}));
}

TEST(Affine, a_form_that_has_overflowed_says_nothing) {
  const Form large = Form::point(3e38f);
  EXPECT_EQ((large + large).range(), Interval::whole());
  EXPECT_EQ((large * large - large * large).range(), Interval::whole());
  EXPECT_EQ(Form::unrelated(Interval::whole()).range(), Interval::whole());
}

}  // namespace
