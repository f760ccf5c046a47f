#include "model/cull/plane_times.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "model/cull/fill_pattern.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <Round M>
float plane(int resolution, int k, float first, float second) {
  return lerp_planes<M>(lerp_weights(resolution), (k - 1) / 4, first, second)[(k - 1) % 4];
}

/// Sign of R bound - ((R-k) first + k second), exactly.
int side(int r, int k, float first, float second, float bound) {
  return sign_of_sum(
      {static_cast<double>(r) * bound, -static_cast<double>(r - k) * first, -static_cast<double>(k) * second, 0.0});
}

TEST(PlaneTimes, bounds_enclose_the_exact_plane_within_a_few_steps_for_every_sign_and_size) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  auto number = [&] {
    const double magnitude =
        std::ldexp(1 + static_cast<double>(random() >> 11) * 0x1p-53, static_cast<int>(random() % 8) - 4);
    return static_cast<float>(random() % 2 == 0 ? magnitude : -magnitude);
  };
  for (int i = 0; i < 20000; ++i) {
    const float first = number(), second = i % 7 == 0 ? first : number();
    for (int r = kMinResolution; r <= kMaxRayResolution; ++r)
      for (int k = 1; k < r; ++k) {
        const float down = plane<Round::Down>(r, k, first, second), up = plane<Round::Up>(r, k, first, second);
        ASSERT_LE(side(r, k, first, second, down), 0)
            << r << " " << k << std::hexfloat << " " << first << " " << second;
        ASSERT_GE(side(r, k, first, second, up), 0) << r << " " << k << std::hexfloat << " " << first << " " << second;
        const double size = std::fabs(first) + std::fabs(second);
        ASSERT_LE(static_cast<double>(up) - down, size * 0x1p-21);
      }
  }
}

TEST(PlaneTimes, given_a_power_of_two_and_numbers_of_few_bits_then_the_bounds_are_exact) {
  for (const int r : {2, 4, 8, 16})
    for (int k = 1; k < r; ++k) {
      EXPECT_EQ(plane<Round::Down>(r, k, -3, 13), -3 + 16.0f * static_cast<float>(k) / static_cast<float>(r));
      EXPECT_EQ(plane<Round::Up>(r, k, -3, 13), -3 + 16.0f * static_cast<float>(k) / static_cast<float>(r));
    }
}

TEST(PlaneTimes, given_an_infinite_bound_then_the_planes_bound_is_infinite_too) {
  for (int r = kMinResolution; r <= kMaxRayResolution; ++r)
    for (int k = 1; k < r; ++k) {
      EXPECT_EQ(plane<Round::Down>(r, k, -kInfinity, 5), -kInfinity);
      EXPECT_EQ(plane<Round::Down>(r, k, -kInfinity, -kInfinity), -kInfinity);
      EXPECT_EQ(plane<Round::Up>(r, k, -5, kInfinity), kInfinity);
      EXPECT_EQ(plane<Round::Up>(r, k, kInfinity, kInfinity), kInfinity);
    }
}

TEST(PlaneTimes, given_numbers_at_the_end_of_the_range_then_the_bounds_still_enclose) {
  const float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
  for (int r = kMinResolution; r <= kMaxRayResolution; ++r)
    for (int k = 1; k < r; ++k)
      for (const float x : {most, -most, least, -least, 0.0f}) {
        EXPECT_LE(plane<Round::Down>(r, k, x, x), x);
        EXPECT_GE(plane<Round::Up>(r, k, x, x), x);
      }
}

}  // namespace
}  // namespace ctu::cull
