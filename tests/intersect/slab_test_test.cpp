#include "model/intersect/slab_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "model/intersect/slab_kernels.h"
#include "model/numeric/round.h"
#include "tests/intersect/hostile_boxes.h"
#include "tests/oracle/exact_box.h"
#include "tests/oracle/seed.h"

namespace ctu::intersect {
namespace {

using numeric::bits;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kOracleCases = 25'000;
constexpr int kBitCases = 200'000;

Vec3 lo_of(const BoxCase& c, int lane) { return {c.boxes.lo[0][lane], c.boxes.lo[1][lane], c.boxes.lo[2][lane]}; }
Vec3 hi_of(const BoxCase& c, int lane) { return {c.boxes.hi[0][lane], c.boxes.hi[1][lane], c.boxes.hi[2][lane]}; }
bool is_empty(const BoxCase& c, int lane) { return c.boxes.lo[0][lane] == kInfinity; }

template <class Check>
void for_hostile_lanes(int cases, Check check) {
  SCOPED_TRACE(oracle::seed_note());
  HostileBoxes source(oracle::test_seed());
  for (int i = 0; i < cases; ++i) {
    const BoxCase box_case = source.next();
    const PreparedRay ray = prepare_ray(box_case.ray);
    ASSERT_TRUE(ray.valid) << show(box_case, 0);
    const SlabTimes times = slab_test(ray, box_case.boxes, box_case.tmax);
    for (int lane = 0; lane < kLanes; ++lane) {
      check(box_case, times, lane);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

TEST(SlabTest, plane_times_enclose_the_exact_ones) {
  for_hostile_lanes(kOracleCases, [](const BoxCase& c, const SlabTimes& times, int lane) {
    for (int axis = 0; axis < 3; ++axis) {
      if (c.ray.direction[axis] == 0 || is_empty(c, lane)) continue;
      const bool forward = c.ray.direction[axis] > 0;
      const float lo = c.boxes.lo[axis][lane], hi = c.boxes.hi[axis][lane];
      const oracle::ExactTime near = oracle::exact_plane_time(c.ray, axis, forward ? lo : hi);
      const oracle::ExactTime far = oracle::exact_plane_time(c.ray, axis, forward ? hi : lo);
      ASSERT_LE(times.near_down[axis][lane], near.down) << "axis " << axis << show(c, lane);
      ASSERT_GE(times.near_up[axis][lane], near.up) << "axis " << axis << show(c, lane);
      ASSERT_LE(times.far_down[axis][lane], far.down) << "axis " << axis << show(c, lane);
      ASSERT_GE(times.far_up[axis][lane], far.up) << "axis " << axis << show(c, lane);
    }
  });
}

// Three roundings, each by less than one place: wider would cost culling without need. The reciprocal of a direction
// beyond 2^126 is subnormal and has fewer digits, and the same holds for times that small; differences may overflow.
TEST(SlabTest, plane_times_are_at_most_four_places_from_exact) {
  for_hostile_lanes(kOracleCases / 4, [](const BoxCase& c, const SlabTimes& times, int lane) {
    for (int axis = 0; axis < 3; ++axis) {
      const float d = std::fabs(c.ray.direction[axis]);
      if (is_empty(c, lane) || d < 0x1p-125f || d > 0x1p125f) continue;
      const float near_plane = c.ray.direction[axis] > 0 ? c.boxes.lo[axis][lane] : c.boxes.hi[axis][lane];
      if (std::max(std::fabs(near_plane), std::fabs(c.ray.origin[axis])) > 0x1p126f) continue;
      const oracle::ExactTime exact = oracle::exact_plane_time(c.ray, axis, near_plane);
      if (exact.down != 0 && (std::fabs(exact.down) < 0x1p-125f || std::fabs(exact.down) > 0x1p126f)) continue;
      if (exact.down == 0 && exact.up != 0) continue;
      float lower = times.near_down[axis][lane], upper = times.near_up[axis][lane];
      if (exact.down == 0) {
        ASSERT_EQ(bits(lower), 0u) << show(c, lane);
        ASSERT_EQ(bits(upper), 0u) << show(c, lane);
        continue;
      }
      for (int place = 0; place < 4; ++place) lower = numeric::next_up(lower), upper = numeric::next_down(upper);
      ASSERT_GE(lower, exact.down) << "axis " << axis << show(c, lane);
      ASSERT_LE(upper, exact.up) << "axis " << axis << show(c, lane);
    }
  });
}

TEST(SlabTest, a_box_met_in_exact_arithmetic_is_hit_and_its_span_enclosed) {
  int met = 0, passed = 0, lanes = 0;
  for_hostile_lanes(kOracleCases, [&](const BoxCase& c, const SlabTimes& times, int lane) {
    const oracle::ExactBoxSpan exact =
        oracle::exact_box_span(c.ray, lo_of(c, lane), hi_of(c, lane), c.ray.tmin, c.tmax);
    const bool hit = times.hit >> lane & 1;
    ++lanes, met += exact.hit, passed += hit;
    if (!exact.hit) return;
    ASSERT_TRUE(hit) << show(c, lane);
    ASSERT_LE(times.t0[lane], exact.entry.down) << show(c, lane);
    ASSERT_GE(times.t1[lane], exact.exit.up) << show(c, lane);
  });
  RecordProperty("lanes", lanes);
  RecordProperty("met_exactly", met);
  RecordProperty("hit", passed);
  EXPECT_GT(met, lanes / 20) << "the cases hardly ever hit: they test nothing";
}

TEST(SlabTest, no_nan_occurs_and_bounds_are_in_order) {
  for_hostile_lanes(kBitCases, [](const BoxCase& c, const SlabTimes& times, int lane) {
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_TRUE(times.near_down[axis][lane] <= times.near_up[axis][lane]) << show(c, lane);
      ASSERT_TRUE(times.far_down[axis][lane] <= times.far_up[axis][lane]) << show(c, lane);
      if (is_empty(c, lane)) continue;
      const bool inside = c.boxes.lo[axis][lane] <= c.ray.origin[axis] && c.ray.origin[axis] <= c.boxes.hi[axis][lane];
      if (c.ray.direction[axis] == 0) {
        ASSERT_EQ(times.near_down[axis][lane], inside ? -kInfinity : kInfinity) << show(c, lane);
        ASSERT_EQ(times.near_up[axis][lane], inside ? -kInfinity : kInfinity) << show(c, lane);
        ASSERT_EQ(times.far_down[axis][lane], inside ? kInfinity : -kInfinity) << show(c, lane);
        ASSERT_EQ(times.far_up[axis][lane], inside ? kInfinity : -kInfinity) << show(c, lane);
      }
    }
    ASSERT_FALSE(std::isnan(times.t0[lane])) << show(c, lane);
    ASSERT_FALSE(std::isnan(times.t1[lane])) << show(c, lane);
  });
}

TEST(SlabTest, the_span_is_the_max_and_min_of_its_bounds_and_decides_the_hit) {
  for_hostile_lanes(kBitCases, [](const BoxCase& c, const SlabTimes& times, int lane) {
    float t0 = c.ray.tmin, t1 = c.tmax;
    for (int axis = 0; axis < 3; ++axis) {
      t0 = numeric::max(t0, times.near_down[axis][lane]);
      t1 = numeric::min(t1, times.far_up[axis][lane]);
    }
    ASSERT_EQ(bits(times.t0[lane]), bits(t0)) << show(c, lane);
    ASSERT_EQ(bits(times.t1[lane]), bits(t1)) << show(c, lane);
    ASSERT_EQ(times.hit >> lane & 1, t0 <= t1) << show(c, lane);
    ASSERT_FALSE(is_empty(c, lane) && (times.hit >> lane & 1)) << show(c, lane);
  });
}

/// The whole struct but its padding.
void expect_same_bits(const SlabTimes& a, const SlabTimes& b, const BoxCase& c) {
  const std::size_t filled = offsetof(SlabTimes, hit) + sizeof a.hit;
  ASSERT_EQ(std::memcmp(&a, &b, filled), 0) << show(c, 0) << show(c, 1) << show(c, 2) << show(c, 3);
}

void expect_same_outer_bits(const SlabTimes& outer, const SlabTimes& full, const BoxCase& c) {
  ASSERT_EQ(outer.hit, full.hit) << show(c, 0);
  ASSERT_EQ(std::memcmp(outer.t0, full.t0, sizeof full.t0), 0) << show(c, 0) << show(c, 1) << show(c, 2) << show(c, 3);
  ASSERT_EQ(std::memcmp(outer.t1, full.t1, sizeof full.t1), 0) << show(c, 0) << show(c, 1) << show(c, 2) << show(c, 3);
}

template <class Full, class Outer>
void expect_form_gives_the_defined_bits(Full full_form, Outer outer_form) {
  SCOPED_TRACE(oracle::seed_note());
  HostileBoxes source(oracle::test_seed() + 1);
  for (int i = 0; i < kBitCases; ++i) {
    const BoxCase c = source.next();
    const PreparedRay ray = prepare_ray(c.ray);
    const SlabTimes defined = portable::slab_test(ray, c.boxes, c.tmax);
    expect_same_bits(full_form(ray, c.boxes, c.tmax), defined, c);
    SlabTimes outer;
    outer_form(ray, c.boxes, c.tmax, outer);
    expect_same_outer_bits(outer, defined, c);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(SlabTest, the_form_callers_get_gives_the_defined_bits) {
  expect_form_gives_the_defined_bits(slab_test, slab_test_outer);
}
TEST(SlabTest, the_outer_form_gives_the_bits_of_the_full_one) {
  expect_form_gives_the_defined_bits(portable::slab_test, portable::slab_test_outer);
}
#if CTU_FUSED_SLAB
TEST(SlabTest, fused_multiply_adds_give_the_defined_bits) {
  expect_form_gives_the_defined_bits(fused::slab_test, fused::slab_test_outer);
}
#endif
#if CTU_EMBEDDED_ROUNDING
TEST(SlabTest, embedded_rounding_gives_the_defined_bits) {
  expect_form_gives_the_defined_bits(embedded::slab_test, embedded::slab_test_outer);
}
#endif

TEST(SlabTest, known_times_come_out_exactly) {
  Ray ray;
  ray.origin = {-2, 1, 5};
  ray.direction = {2, 0, -4};
  ray.tmax = 10;
  Box4 boxes;
  for (int lane = 0; lane < kLanes; ++lane) {
    const float lo[3] = {0, 0, 0}, hi[3] = {4, 1, 1};
    for (int axis = 0; axis < 3; ++axis) boxes.lo[axis][lane] = lo[axis], boxes.hi[axis][lane] = hi[axis];
  }
  boxes.lo[1][1] = 1.5f, boxes.hi[1][1] = 2;                                                           // beside the ray
  for (int axis = 0; axis < 3; ++axis) boxes.lo[axis][2] = kInfinity, boxes.hi[axis][2] = -kInfinity;  // empty
  boxes.lo[0][3] = boxes.hi[0][3] = 0.25f;  // flat, met at t = 1.125
  const SlabTimes times = slab_test(prepare_ray(ray), boxes, ray.tmax);
  EXPECT_EQ(times.hit, 0b1001);
  EXPECT_EQ(times.near_down[0][0], 1.0f);
  EXPECT_EQ(times.far_up[0][0], 3.0f);
  EXPECT_EQ(times.near_up[2][0], 1.0f);
  EXPECT_EQ(times.far_down[2][0], 1.25f);
  EXPECT_EQ(times.t0[0], 1.0f);
  EXPECT_EQ(times.t1[0], 1.25f);
  EXPECT_EQ(times.t0[3], 1.125f);
  EXPECT_EQ(times.t1[3], 1.125f);
}

}  // namespace
}  // namespace ctu::intersect
