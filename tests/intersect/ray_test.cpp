#include "model/intersect/ray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "model/numeric/round.h"
#include "tests/oracle/seed.h"

namespace ctu::intersect {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
const float kNan = std::numeric_limits<float>::quiet_NaN();

Ray good_ray() {
  Ray ray;
  ray.origin = {1, 2, 3};
  ray.direction = {0, -0.0f, -2};
  ray.tmax = kInfinity;
  return ray;
}

TEST(RayRules, an_infinite_tmax_and_tmin_equal_to_tmax_are_accepted) {
  EXPECT_TRUE(is_valid(good_ray()));
  Ray ray = good_ray();
  ray.tmin = ray.tmax = 5;
  EXPECT_TRUE(is_valid(ray));
  ray.tmin = -3;
  EXPECT_TRUE(is_valid(ray));
  ray.direction = {0, numeric::from_bits(1), 0};
  EXPECT_TRUE(is_valid(ray)) << "the smallest subnormal is a direction";
}

TEST(RayRules, numbers_that_are_not_finite_are_refused) {
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Ray ray = good_ray();
      ray.origin[axis] = bad;
      EXPECT_FALSE(is_valid(ray));
      ray = good_ray();
      ray.direction[axis] = bad;
      EXPECT_FALSE(is_valid(ray));
    }
    Ray ray = good_ray();
    ray.tmin = bad;
    EXPECT_FALSE(is_valid(ray));
  }
  Ray ray = good_ray();
  ray.tmax = kNan;
  EXPECT_FALSE(is_valid(ray));
}

TEST(RayRules, zero_directions_and_empty_intervals_are_refused) {
  Ray ray = good_ray();
  ray.direction = {0, -0.0f, 0};
  EXPECT_FALSE(is_valid(ray));
  ray = good_ray();
  ray.tmin = 2, ray.tmax = 1;
  EXPECT_FALSE(is_valid(ray));
  ray.tmax = -kInfinity;
  EXPECT_FALSE(is_valid(ray));
  EXPECT_FALSE(prepare_ray(ray).valid);
}

TEST(PreparedRay, says_which_axes_stand_still_and_which_run_backwards) {
  const PreparedRay ray = prepare_ray(good_ray());
  ASSERT_TRUE(ray.valid);
  EXPECT_EQ(ray.zero_axes, 0b011);
  EXPECT_EQ(ray.negative_axes, 0b100);
  EXPECT_EQ(ray.rcp_down.z, -0.5f);
  EXPECT_EQ(ray.rcp_up.z, -0.5f);
  EXPECT_EQ(ray.kz, 2);
}

TEST(PreparedRay, reciprocals_enclose_and_are_neighbours) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  for (int i = 0; i < 200'000; ++i) {
    Ray ray = good_ray();
    const float d = numeric::from_bits(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(d) || d == 0) continue;
    ray.direction.x = d;
    const PreparedRay prepared = prepare_ray(ray);
    const double exact = 1.0 / static_cast<double>(d);
    ASSERT_LE(prepared.rcp_down.x, exact) << std::hex << numeric::bits(d);
    ASSERT_GE(prepared.rcp_up.x, exact) << std::hex << numeric::bits(d);
    ASSERT_TRUE(prepared.rcp_down.x == prepared.rcp_up.x || numeric::next_up(prepared.rcp_down.x) == prepared.rcp_up.x)
        << std::hex << numeric::bits(d);
  }
}

TEST(PreparedRay, the_shear_runs_along_the_largest_component_and_keeps_the_winding) {
  const Vec3 directions[] = {{3, 1, -2}, {-3, 1, 2}, {1, 3, 2}, {1, -3, 2},
                             {1, 2, 3},  {1, 2, -3}, {1, 1, 1}, {-1, -1, 0}};
  for (const Vec3& direction : directions) {
    Ray ray = good_ray();
    ray.direction = direction;
    const PreparedRay p = prepare_ray(ray);
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::fabs(direction[axis]), std::fabs(direction[p.kz]));
    EXPECT_EQ(p.kx + p.ky + p.kz, 3);
    const bool cyclic = p.kx == (p.kz + 1) % 3 && p.ky == (p.kz + 2) % 3;
    EXPECT_EQ(cyclic, direction[p.kz] > 0);
    EXPECT_EQ(p.sx, direction[p.kx] / direction[p.kz]);
    EXPECT_EQ(p.sy, direction[p.ky] / direction[p.kz]);
  }
}

TEST(HitRule, nearer_wins_and_equal_distances_go_to_the_lower_primitive) {
  const Hit best{2, 0, 0, 7};
  EXPECT_TRUE(replaces(1.9f, 9, best));
  EXPECT_TRUE(replaces(2, 6, best));
  EXPECT_FALSE(replaces(2, 7, best));
  EXPECT_FALSE(replaces(2, 8, best));
  EXPECT_FALSE(replaces(2.1f, 1, best));
  EXPECT_TRUE(replaces(kInfinity, 0, Hit{kInfinity, 0, 0, kNoPrimitive}));
}

TEST(HitRule, same_bits_tells_zeros_apart_and_takes_a_nan_for_itself) {
  EXPECT_FALSE(same_bits(Hit{0.0f, 0, 0, 1}, Hit{-0.0f, 0, 0, 1}));
  EXPECT_TRUE(same_bits(Hit{kNan, 0, 0, 1}, Hit{kNan, 0, 0, 1}));
  EXPECT_FALSE(same_bits(Hit{1, 0, 0, 1}, Hit{1, 0, 0, 2}));
}

}  // namespace
}  // namespace ctu::intersect
