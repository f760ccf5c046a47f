// Float units with registers: a result leaves exactly LATENCY enabled cycles after its operands, whatever stands before
// and behind it, with operation and direction changing every cycle and the enable withheld at random.
#include <gtest/gtest.h>

#include <bit>
#include <deque>
#include <random>
#include <type_traits>

#include "VFloatPipelines.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/float/float_operations.h"
#include "tests/rtl/float/float_vectors.h"

namespace ctu::rtl {
namespace {

constexpr int kCycles = 60'000;

constexpr std::size_t kDivideStep = 4;  // as pipeline_bench.sv

struct Results {
  std::uint32_t sum, product, quotients;
};

/// All three roundings in one word, as pipeline_bench.sv joins them.
std::uint32_t joined_quotients(Pair pair) {
  return kDivide.defined(Round::Nearest, pair) ^ std::rotl(kDivide.defined(Round::Down, pair), 1) ^
         std::rotl(kDivide.defined(Round::Up, pair), 2);
}

TEST(FloatPipelines, results_leave_after_exactly_the_latency_whatever_cycles_are_withheld) {
  SCOPED_TRACE(oracle::seed_note());
  VerilatedContext context;
  VFloatPipelines unit(&context);
  constexpr std::size_t kLatencies = std::extent_v<std::remove_reference_t<decltype(unit.sum_o)>>;
  ASSERT_EQ(kLatencies, 10u);
  HardPairs operands(oracle::test_seed());
  std::mt19937_64 random(oracle::test_seed() + 1);
  std::deque<Results> entered;  // the latest first
  std::uint64_t compared = 0;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    const Pair pair = operands.next();
    const Round round = kRounds[random() % 3];
    const bool subtract = random() % 2, enable = random() % 4 != 0;
    unit.clk_i = 0;
    unit.enable_i = enable;
    unit.a_i = numeric::bits(pair.first);
    unit.b_i = numeric::bits(pair.second);
    unit.subtract_i = subtract;
    unit.round_i = static_cast<std::uint8_t>(round);
    unit.eval();
    entered.push_front(
        {(subtract ? kSubtract : kAdd).defined(round, pair), kMultiply.defined(round, pair), joined_quotients(pair)});
    for (std::size_t latency = 0; latency < std::min(kLatencies, entered.size()); ++latency) {
      ASSERT_EQ(unit.sum_o[latency], entered[latency].sum) << "latency " << latency << ", cycle " << cycle;
      ASSERT_EQ(unit.product_o[latency], entered[latency].product) << "latency " << latency << ", cycle " << cycle;
      ++compared;
    }
    for (std::size_t i = 0; i < kLatencies && i * kDivideStep < entered.size(); ++i) {
      ASSERT_EQ(unit.quotient_o[i], entered[i * kDivideStep].quotients)
          << "latency " << i * kDivideStep << ", cycle " << cycle;
    }
    unit.clk_i = 1;
    unit.eval();
    if (!enable) entered.pop_front();
    if (entered.size() > kLatencies * kDivideStep) entered.pop_back();
  }
  EXPECT_GT(compared, kCycles * (kLatencies - 1));
}

}  // namespace
}  // namespace ctu::rtl
