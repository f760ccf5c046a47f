// Each float unit of rtl/ against model/numeric, bit for bit: all pairs of corners, and random pairs. CTU_LONG_TESTS=1
// takes ten million random pairs for each operation and direction, CTU_RTL_PAIRS any other number.
#include <gtest/gtest.h>

#include <cstdlib>

#include "VFloatAdd.h"
#include "VFloatCompare.h"
#include "VFloatDiv.h"
#include "VFloatMinMax.h"
#include "VFloatMul.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/float/float_operations.h"
#include "tests/rtl/float/float_vectors.h"
#include "tests/rtl/float/verilated_float_unit.h"

namespace ctu::rtl {
namespace {

constexpr std::size_t kBatch = 1 << 14;

std::size_t random_count() {
  if (const char* given = std::getenv("CTU_RTL_PAIRS")) return std::strtoull(given, nullptr, 10);
  return std::getenv("CTU_LONG_TESTS") ? 10'000'000 : 400'000;
}

void expect_defined_bits(FloatUnit& unit, const Operation& operation, Round round) {
  const Verdict at_corners = first_difference(unit, operation, round, corner_pairs());
  ASSERT_FALSE(at_corners.differs) << show(operation, round, at_corners);

  SCOPED_TRACE(oracle::seed_note());
  HardPairs random(oracle::test_seed() + static_cast<std::uint64_t>(round));
  std::vector<Pair> pairs;
  for (std::size_t done = 0; done < random_count(); done += pairs.size()) {
    random.fill(pairs, kBatch);
    const Verdict verdict = first_difference(unit, operation, round, pairs);
    ASSERT_FALSE(verdict.differs) << show(operation, round, verdict);
  }
}

/// The operations that round, each in each direction.
class RoundedOperation : public testing::TestWithParam<Round> {};

TEST_P(RoundedOperation, add_gives_the_defined_bits) {
  VerilatedFloatUnit<VFloatAdd> unit;
  expect_defined_bits(unit, kAdd, GetParam());
}
TEST_P(RoundedOperation, subtract_gives_the_defined_bits) {
  VerilatedFloatUnit<VFloatAdd> unit;
  expect_defined_bits(unit, kSubtract, GetParam());
}
TEST_P(RoundedOperation, multiply_gives_the_defined_bits) {
  VerilatedFloatUnit<VFloatMul> unit;
  expect_defined_bits(unit, kMultiply, GetParam());
}
TEST_P(RoundedOperation, divide_gives_the_defined_bits) {
  VerilatedFloatUnit<VFloatDiv> unit;
  expect_defined_bits(unit, kDivide, GetParam());
}

INSTANTIATE_TEST_SUITE_P(FloatUnits, RoundedOperation, testing::ValuesIn(kRounds), [](const auto& info) {
  return info.param == Round::Nearest ? "nearest" : info.param == Round::Down ? "down" : "up";
});

TEST(FloatUnits, min_gives_the_defined_bits) {
  VerilatedFloatUnit<VFloatMinMax> unit;
  expect_defined_bits(unit, kMin, Round::Nearest);
}
TEST(FloatUnits, max_gives_the_defined_bits) {
  VerilatedFloatUnit<VFloatMinMax> unit;
  expect_defined_bits(unit, kMax, Round::Nearest);
}
TEST(FloatUnits, compare_gives_the_defined_order) {
  VerilatedFloatUnit<VFloatCompare> unit;
  expect_defined_bits(unit, kCompare, Round::Nearest);
}

}  // namespace
}  // namespace ctu::rtl
