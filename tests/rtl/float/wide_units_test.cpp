// The wide units against exact rounding, without registers and with them, and units broken on purpose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <type_traits>

#include "VMutantWideAlignmentSticky.h"
#include "VMutantWideDifferenceSticky.h"
#include "VMutantWideProductSticky.h"
#include "VMutantWideQuotientWraps.h"
#include "VMutantWideRatioSticky.h"
#include "VMutantWideRootSticky.h"
#include "VMutantWideTiesAway.h"
#include "VMutantWideZeroSign.h"
#include "VWidePipelines.h"
#include "VWideUnits.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/float/verilated_wide_units.h"

namespace ctu::rtl {
namespace {

TEST(WideUnits, give_the_exact_value_rounded_once) {
  SCOPED_TRACE(oracle::seed_note());
  const int cases = std::getenv("CTU_LONG_TESTS") ? 1'000'000 : 100'000;
  VerilatedWideUnits<VWideUnits> units;
  HardWideOperands operands(oracle::test_seed());
  EXPECT_EQ(wide_difference(units, operands, cases), "");
}

TEST(WideUnits, results_leave_after_exactly_the_latency_whatever_cycles_are_withheld) {
  SCOPED_TRACE(oracle::seed_note());
  VerilatedContext context;
  VWidePipelines unit(&context);
  constexpr std::size_t kDivideStep = 4;  // as wide_bench.sv
  constexpr std::size_t kLatencies = std::extent_v<std::remove_reference_t<decltype(unit.sum_o)>>;
  ASSERT_EQ(kLatencies, 11u);
  HardWideOperands operands(oracle::test_seed());
  std::mt19937_64 random(oracle::test_seed() + 1);
  std::deque<WideResults> entered;  // the latest first, as the units without registers see it
  for (int cycle = 0; cycle < 20'000; ++cycle) {
    const bool enable = random() % 4 != 0;
    set_operands(unit, operands.next());
    unit.clk_i = 0;
    unit.enable_i = enable;
    unit.eval();
    entered.push_front({.sum = unit.sum_o[0],
                        .product = unit.product_o[0],
                        .difference = unit.difference_o[0],
                        .quotient = unit.quotient_o[0],
                        .ratio = unit.ratio_o[0],
                        .root = unit.root_o[0]});
    for (std::size_t latency = 1; latency < std::min(kLatencies, entered.size()); ++latency) {
      ASSERT_EQ(unit.sum_o[latency], entered[latency].sum) << "latency " << latency << ", cycle " << cycle;
      ASSERT_EQ(unit.product_o[latency], entered[latency].product) << "latency " << latency << ", cycle " << cycle;
      ASSERT_EQ(unit.difference_o[latency], entered[latency].difference)
          << "latency " << latency << ", cycle " << cycle;
    }
    for (std::size_t i = 1; i < kLatencies && i * kDivideStep < entered.size(); ++i) {
      const WideResults& should = entered[i * kDivideStep];
      ASSERT_EQ(unit.quotient_o[i], should.quotient) << "latency " << i * kDivideStep << ", cycle " << cycle;
      ASSERT_EQ(unit.ratio_o[i], should.ratio) << "latency " << i * kDivideStep << ", cycle " << cycle;
      ASSERT_EQ(unit.root_o[i], should.root) << "latency " << i * kDivideStep << ", cycle " << cycle;
    }
    unit.clk_i = 1;
    unit.eval();
    if (!enable) entered.pop_front();
    if (entered.size() > kLatencies * kDivideStep) entered.pop_back();
  }
}

template <class Model>
void expect_caught() {
  SCOPED_TRACE(oracle::seed_note());
  VerilatedWideUnits<Model> units;
  HardWideOperands operands(oracle::test_seed());
  const std::string difference = wide_difference(units, operands, 100'000);
  EXPECT_NE(difference, "");
  std::cout << difference << '\n';
}

TEST(WideMutants, ties_rounded_away_from_zero_are_caught) { expect_caught<VMutantWideTiesAway>(); }
TEST(WideMutants, bits_lost_in_alignment_are_caught) { expect_caught<VMutantWideAlignmentSticky>(); }
TEST(WideMutants, the_last_bit_of_a_product_lost_is_caught) { expect_caught<VMutantWideProductSticky>(); }
TEST(WideMutants, the_last_bits_of_a_difference_of_products_lost_are_caught) {
  expect_caught<VMutantWideDifferenceSticky>();
}
TEST(WideMutants, a_quotient_far_beyond_binary32_that_wraps_is_caught) { expect_caught<VMutantWideQuotientWraps>(); }
TEST(WideMutants, the_last_bits_of_a_ratio_lost_are_caught) { expect_caught<VMutantWideRatioSticky>(); }
TEST(WideMutants, the_last_bits_of_a_root_lost_are_caught) { expect_caught<VMutantWideRootSticky>(); }
TEST(WideMutants, a_quotient_of_minus_zero_is_caught) { expect_caught<VMutantWideZeroSign>(); }

}  // namespace
}  // namespace ctu::rtl
