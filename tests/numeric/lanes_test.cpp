#include <gtest/gtest.h>

#include <cmath>

#include "model/numeric/lanes.h"
#include "tests/numeric/operands.h"
#include "tests/oracle/seed.h"

namespace ctu::numeric {
namespace {

constexpr int kRandomPairs = 400'000;

/// Holds a four-lane function equal to a scalar one, with other operands in the other lanes.
template <class Lanes, class Scalar>
void expect_same_bits(Lanes lanes, Scalar scalar) {
  SCOPED_TRACE(oracle::seed_note());
  std::vector<Pair> pairs = operand_pairs(oracle::test_seed(), kRandomPairs);
  pairs.resize(pairs.size() / 4 * 4);
  for (std::size_t i = 0; i < pairs.size(); i += 4) {
    Float4 a, b;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      a[lane] = pairs[i + lane].first;
      b[lane] = pairs[i + lane].second;
    }
    const Float4 is = lanes(a, b);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      ASSERT_EQ(bits(is[lane]), bits(scalar(a[lane], b[lane])))
          << std::hex << "operands 0x" << bits(a[lane]) << " 0x" << bits(b[lane]) << " in lane " << lane;
    }
  }
}

template <Round M>
void expect_every_operation_same() {
  // The form that callers get, embedded rounding where the target has it: the same names for lanes and scalars.
  const auto plus = [](auto a, auto b) { return add<M>(a, b); };
  const auto minus = [](auto a, auto b) { return sub<M>(a, b); };
  const auto times = [](auto a, auto b) { return mul<M>(a, b); };
  const auto over = [](auto a, auto b) { return div<M>(a, b); };
  expect_same_bits(plus, plus);
  expect_same_bits(minus, minus);
  expect_same_bits(times, times);
  expect_same_bits(over, over);
  expect_same_bits([](Float4 a, Float4 b) { return portable::add<M>(a, b); }, plus);
  expect_same_bits([](Float4 a, Float4 b) { return portable::sub<M>(a, b); }, minus);
  expect_same_bits([](Float4 a, Float4 b) { return portable::mul<M>(a, b); }, times);
  expect_same_bits([](Float4 a, Float4 b) { return portable::div<M>(a, b); }, over);
}

TEST(Lanes, nearest_operations_give_the_scalar_bits) { expect_every_operation_same<Round::Nearest>(); }
TEST(Lanes, downward_operations_give_the_scalar_bits) { expect_every_operation_same<Round::Down>(); }
TEST(Lanes, upward_operations_give_the_scalar_bits) { expect_every_operation_same<Round::Up>(); }

TEST(Lanes, min_and_max_give_the_scalar_bits) {
  const auto lower = [](auto a, auto b) { return min(a, b); };
  const auto upper = [](auto a, auto b) { return max(a, b); };
  expect_same_bits(lower, lower);
  expect_same_bits(upper, upper);
}

TEST(Lanes, lane_set_gathers_one_bit_a_lane) {
  EXPECT_EQ(lane_set(Mask4{0, 0, 0, 0}), 0u);
  EXPECT_EQ(lane_set(Mask4{-1, 0, 0, 0}), 1u);
  EXPECT_EQ(lane_set(Mask4{0, -1, 0, -1}), 10u);
  EXPECT_EQ(lane_set(Mask4{-1, -1, -1, -1}), 15u);
}

}  // namespace
}  // namespace ctu::numeric
