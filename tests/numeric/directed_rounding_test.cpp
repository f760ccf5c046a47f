#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "model/numeric/round.h"
#include "tests/numeric/operands.h"
#include "tests/oracle/exact_round.h"
#include "tests/oracle/seed.h"

namespace ctu::numeric {
namespace {

using oracle::Operation;

constexpr int kRandomPairs = 150'000;

std::string show(float x) {
  char text[64];
  std::snprintf(text, sizeof text, "0x%08x (%.9g)", bits(x), static_cast<double>(x));
  return text;
}

template <Round M>
float scalar(Operation operation, float a, float b) {
  switch (operation) {
    case Operation::Add:
      return add<M>(a, b);
    case Operation::Sub:
      return sub<M>(a, b);
    case Operation::Mul:
      return mul<M>(a, b);
    case Operation::Div:
      return div<M>(a, b);
  }
  return 0;
}

template <Round M>
void expect_oracle_bits(Operation operation) {
  SCOPED_TRACE(oracle::seed_note());
  for (const auto& [a, b] : operand_pairs(oracle::test_seed(), kRandomPairs)) {
    const float is = scalar<M>(operation, a, b), should = oracle::exact_operation(operation, M, a, b);
    ASSERT_EQ(bits(is), bits(should)) << "operation " << static_cast<int>(operation) << " of " << show(a) << " and "
                                      << show(b) << " gave " << show(is) << ", exactly rounded " << show(should);
  }
}

TEST(DirectedRounding, add_to_nearest_gives_the_exactly_rounded_bits) {
  expect_oracle_bits<Round::Nearest>(Operation::Add);
}
TEST(DirectedRounding, add_down_gives_the_exactly_rounded_bits) { expect_oracle_bits<Round::Down>(Operation::Add); }
TEST(DirectedRounding, add_up_gives_the_exactly_rounded_bits) { expect_oracle_bits<Round::Up>(Operation::Add); }
TEST(DirectedRounding, sub_to_nearest_gives_the_exactly_rounded_bits) {
  expect_oracle_bits<Round::Nearest>(Operation::Sub);
}
TEST(DirectedRounding, sub_down_gives_the_exactly_rounded_bits) { expect_oracle_bits<Round::Down>(Operation::Sub); }
TEST(DirectedRounding, sub_up_gives_the_exactly_rounded_bits) { expect_oracle_bits<Round::Up>(Operation::Sub); }
TEST(DirectedRounding, mul_to_nearest_gives_the_exactly_rounded_bits) {
  expect_oracle_bits<Round::Nearest>(Operation::Mul);
}
TEST(DirectedRounding, mul_down_gives_the_exactly_rounded_bits) { expect_oracle_bits<Round::Down>(Operation::Mul); }
TEST(DirectedRounding, mul_up_gives_the_exactly_rounded_bits) { expect_oracle_bits<Round::Up>(Operation::Mul); }
TEST(DirectedRounding, div_to_nearest_gives_the_exactly_rounded_bits) {
  expect_oracle_bits<Round::Nearest>(Operation::Div);
}
TEST(DirectedRounding, div_down_gives_the_exactly_rounded_bits) { expect_oracle_bits<Round::Down>(Operation::Div); }
TEST(DirectedRounding, div_up_gives_the_exactly_rounded_bits) { expect_oracle_bits<Round::Up>(Operation::Div); }

// The oracle itself, on results known in closed form.
TEST(ExactOracle, rounds_known_cases_as_ieee_754_says) {
  const float one = 1.0f, tiny = from_bits(1), most = std::numeric_limits<float>::max();
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Add, Round::Up, one, tiny)), 0x3f800001u);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Add, Round::Down, one, -tiny)), 0x3f7fffffu);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Add, Round::Down, one, -one)), 0x80000000u);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Mul, Round::Up, tiny, tiny)), 0x00000001u);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Mul, Round::Nearest, tiny, -tiny)), 0x80000000u);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Mul, Round::Nearest, tiny, 0.5f)), 0x00000000u);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Mul, Round::Nearest, from_bits(3), 0.5f)), 0x00000002u);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Mul, Round::Down, most, 2.0f)), 0x7f7fffffu);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Mul, Round::Nearest, most, 2.0f)), 0x7f800000u);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Add, Round::Nearest, most, std::ldexp(1.0f, 102))), 0x7f7fffffu);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Add, Round::Nearest, most, std::ldexp(1.0f, 103))), 0x7f800000u);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Div, Round::Down, one, 3.0f)), 0x3eaaaaaau);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Div, Round::Up, one, 3.0f)), 0x3eaaaaabu);
  EXPECT_EQ(bits(oracle::exact_operation(Operation::Div, Round::Up, one, 0.0f)), 0x7f800000u);
}

TEST(DirectedRounding, down_nearest_and_up_are_at_most_neighbours_and_in_order) {
  SCOPED_TRACE(oracle::seed_note());
  RandomPairs random(oracle::test_seed() + 1);
  for (int i = 0; i < 1'000'000; ++i) {
    const auto [a, b] = random.next();
    for (const Operation operation : {Operation::Add, Operation::Sub, Operation::Mul, Operation::Div}) {
      const float down = scalar<Round::Down>(operation, a, b), up = scalar<Round::Up>(operation, a, b);
      const float nearest = scalar<Round::Nearest>(operation, a, b);
      if (std::isnan(nearest)) continue;
      ASSERT_LE(down, nearest) << show(a) << " " << show(b);
      ASSERT_LE(nearest, up) << show(a) << " " << show(b);
      ASSERT_TRUE(down == up || next_up(down) == up) << show(a) << " " << show(b);
    }
  }
}

TEST(Neighbours, step_along_the_binary32_line_and_stop_at_its_ends) {
  const float infinity = std::numeric_limits<float>::infinity(), most = std::numeric_limits<float>::max();
  EXPECT_EQ(bits(next_up(0.0f)), 1u);
  EXPECT_EQ(bits(next_up(-0.0f)), 1u);
  EXPECT_EQ(bits(next_down(0.0f)), 0x80000001u);
  EXPECT_EQ(bits(next_down(-0.0f)), 0x80000001u);
  EXPECT_EQ(bits(next_up(from_bits(0x80000001u))), 0x80000000u);
  EXPECT_EQ(next_up(most), infinity);
  EXPECT_EQ(next_up(infinity), infinity);
  EXPECT_EQ(next_up(-infinity), -most);
  EXPECT_EQ(next_down(infinity), most);
  EXPECT_EQ(next_down(-infinity), -infinity);
  EXPECT_EQ(bits(next_up(from_bits(0xffffffffu))), kCanonicalNan);
  RandomPairs random(oracle::test_seed());
  for (int i = 0; i < 100'000; ++i) {
    const float x = random.next().second;
    if (std::isnan(x)) continue;
    EXPECT_EQ(next_up(x), std::nextafter(x, infinity)) << show(x);
    EXPECT_EQ(next_down(x), std::nextafter(x, -infinity)) << show(x);
  }
}

TEST(MinMax, give_the_number_beside_a_nan_and_order_negative_zero_first) {
  const float nan = from_bits(0xffc00001u);
  EXPECT_EQ(bits(min(nan, 1.0f)), bits(1.0f));
  EXPECT_EQ(bits(max(1.0f, nan)), bits(1.0f));
  EXPECT_EQ(bits(max(nan, nan)), kCanonicalNan);
  EXPECT_EQ(bits(min(nan, nan)), kCanonicalNan);
  EXPECT_EQ(bits(min(0.0f, -0.0f)), 0x80000000u);
  EXPECT_EQ(bits(min(-0.0f, 0.0f)), 0x80000000u);
  EXPECT_EQ(bits(max(0.0f, -0.0f)), 0u);
  EXPECT_EQ(bits(max(-0.0f, 0.0f)), 0u);
  for (const auto& [a, b] : operand_pairs(oracle::test_seed(), 10'000)) {
    if (std::isnan(a) || std::isnan(b)) continue;
    EXPECT_EQ(min(a, b), std::fmin(a, b));
    EXPECT_EQ(max(a, b), std::fmax(a, b));
    EXPECT_EQ(bits(min(a, b)), bits(min(b, a)));
    EXPECT_EQ(bits(max(a, b)), bits(max(b, a)));
  }
}

}  // namespace
}  // namespace ctu::numeric
