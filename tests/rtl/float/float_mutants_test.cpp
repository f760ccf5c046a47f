// Float units broken on purpose (CTU_MUTATE_... in rtl/): the vectors of float_units_test must catch every one of them.
#include <gtest/gtest.h>

#include <iostream>

#include "VMutantAlignmentSticky.h"
#include "VMutantDirectionWithoutSign.h"
#include "VMutantFlushSubnormals.h"
#include "VMutantNanSign.h"
#include "VMutantOverflowToInfinity.h"
#include "VMutantProductSticky.h"
#include "VMutantQuotientSticky.h"
#include "VMutantSignOfZero.h"
#include "VMutantSubnormalSticky.h"
#include "VMutantTiesAway.h"
#include "VMutantZerosEqual.h"
#include "VMutantZerosOrdered.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/float/float_operations.h"
#include "tests/rtl/float/float_vectors.h"
#include "tests/rtl/float/verilated_float_unit.h"

namespace ctu::rtl {
namespace {

constexpr std::size_t kRandomPairs = 100'000;

/// `only_in`: a mistake that shows in one direction must be found there.
void expect_caught(FloatUnit& unit, const Operation& operation, Round only_in = Round::Nearest) {
  SCOPED_TRACE(oracle::seed_note());
  std::vector<Pair> pairs = numeric::operand_pairs(0, 0), more;
  HardPairs(oracle::test_seed()).fill(more, kRandomPairs);
  pairs.insert(pairs.end(), more.begin(), more.end());
  const Verdict verdict = first_difference(unit, operation, only_in, pairs);
  ASSERT_TRUE(verdict.differs) << "the mutant of " << operation.name << " behaves as defined";
  std::cout << show(operation, only_in, verdict) << '\n';
}

TEST(FloatMutants, ties_rounded_away_from_zero_are_caught) {
  VerilatedFloatUnit<VMutantTiesAway> unit;
  expect_caught(unit, kMultiply);
}
TEST(FloatMutants, rounding_up_without_a_look_at_the_sign_is_caught) {
  VerilatedFloatUnit<VMutantDirectionWithoutSign> unit;
  expect_caught(unit, kMultiply, Round::Up);
}
TEST(FloatMutants, overflow_to_infinity_against_the_direction_is_caught) {
  VerilatedFloatUnit<VMutantOverflowToInfinity> unit;
  expect_caught(unit, kMultiply, Round::Down);
}
TEST(FloatMutants, flushed_subnormals_are_caught) {
  VerilatedFloatUnit<VMutantFlushSubnormals> unit;
  expect_caught(unit, kAdd);
}
TEST(FloatMutants, a_nan_with_another_sign_is_caught) {
  VerilatedFloatUnit<VMutantNanSign> unit;
  expect_caught(unit, kAdd);
}
TEST(FloatMutants, a_dropped_sticky_bit_of_the_alignment_is_caught) {
  VerilatedFloatUnit<VMutantAlignmentSticky> unit;
  expect_caught(unit, kAdd);
  expect_caught(unit, kSubtract, Round::Down);
}
TEST(FloatMutants, the_sign_of_a_zero_difference_under_down_is_caught) {
  VerilatedFloatUnit<VMutantSignOfZero> unit;
  expect_caught(unit, kSubtract, Round::Down);
}
TEST(FloatMutants, a_dropped_lowest_bit_of_the_product_is_caught) {
  VerilatedFloatUnit<VMutantProductSticky> unit;
  expect_caught(unit, kMultiply, Round::Up);
}
TEST(FloatMutants, a_dropped_sticky_bit_of_subnormal_products_is_caught) {
  VerilatedFloatUnit<VMutantSubnormalSticky> unit;
  expect_caught(unit, kMultiply, Round::Up);
}
TEST(FloatMutants, a_dropped_remainder_of_the_quotient_is_caught) {
  VerilatedFloatUnit<VMutantQuotientSticky> unit;
  expect_caught(unit, kDivide, Round::Up);
}
TEST(FloatMutants, min_that_takes_zeros_as_equal_is_caught) {
  VerilatedFloatUnit<VMutantZerosEqual> unit;
  expect_caught(unit, kMin);
}
TEST(FloatMutants, a_comparison_that_orders_zeros_is_caught) {
  VerilatedFloatUnit<VMutantZerosOrdered> unit;
  expect_caught(unit, kCompare);
}

}  // namespace
}  // namespace ctu::rtl
