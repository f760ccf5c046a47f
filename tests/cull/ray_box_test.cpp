// Ray boxes against exact arithmetic, on hard cases; and what the paper's fixed epsilon loses.
#include "model/cull/ray_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <sstream>

#include "model/accel/leaf_record.h"
#include "model/cull/leaf_culling.h"
#include "sim/check/hard_case.h"
#include "tests/cull/epsilon_ray_box.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/rational.h"
#include "tests/oracle/ray_oracle.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

using accel::LeafTriangle;
using accel::PrimitiveBox;
using intersect::Ray;
using oracle::exact;
using oracle::Rational;

std::string show(const Ray& ray) {
  std::ostringstream text;
  text << "ray bits" << std::hex;
  for (const float f : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z,
                        ray.tmin, ray.tmax})
    text << " 0x" << numeric::bits(f);
  return text.str();
}

bool holds(const PrimitiveBox& box, const Ray& ray, float t) {
  for (int a = 0; a < 3; ++a) {
    const Rational x = exact(ray.origin[a]) + exact(t) * exact(ray.direction[a]);
    const bool above = box.lower[a] == -std::numeric_limits<float>::infinity() || x >= exact(box.lower[a]);
    const bool below = box.upper[a] == std::numeric_limits<float>::infinity() || x <= exact(box.upper[a]);
    if (!above || !below) return false;
  }
  return true;
}

/// All scenes of one round of `ctusim check`'s generators.
template <class Visit>
void for_each_hard_case(std::uint64_t scenes, const Visit& visit) {
  for (std::uint32_t generator = 0; generator < sim::check::generators().size(); ++generator)
    for (std::uint64_t scene = 0; scene < scenes; ++scene) {
      SCOPED_TRACE(sim::check::generators()[generator].name);
      visit(sim::check::make_case(oracle::test_seed(), generator, scene));
    }
}

TEST(RayBox, holds_every_point_of_the_ray_between_its_ends_before_and_after_an_update) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  int asked = 0;
  for_each_hard_case(1, [&](const sim::check::HardCase& hard) {
    for (std::size_t i = 0; i < std::min<std::size_t>(hard.rays.size(), 150); ++i) {
      const Ray& ray = hard.rays[i];
      const float last = std::isfinite(ray.tmax) ? ray.tmax : static_cast<float>(1e3 * share());
      const auto between = [&](float low, float high) {
        const auto t = static_cast<float>(low + share() * (static_cast<double>(high) - low));
        return std::min(std::max(t, low), high);
      };
      if (!(ray.tmin <= last)) continue;
      const float from = between(ray.tmin, last), to = between(from, last), hit = between(from, to);
      RayBox box(ray, from, to);
      for (const float t : {from, hit, to}) ASSERT_TRUE(holds(box.box(), ray, t)) << show(ray) << " t " << t;
      box.end_at(ray, hit);
      for (const float t : {from, between(from, hit), hit})
        ASSERT_TRUE(holds(box.box(), ray, t)) << show(ray) << " t " << t;
      asked += 6;
    }
  });
  EXPECT_GT(asked, 5000);
}

TEST(RayBox, an_infinite_end_is_allowed_on_every_axis) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Ray ray{{1, 2, 3}, 0, {1, -1, 0}, kInfinity};
  const RayBox box(ray, 0, kInfinity);
  EXPECT_EQ(box.box().lower, (Vec3{1, -kInfinity, 3}));
  EXPECT_EQ(box.box().upper, (Vec3{kInfinity, 2, 3}));
}

/// A leaf's stay that encloses the meeting most tightly: nothing is left to the interval, all to the box.
struct Meeting {
  Ray ray;
  LeafTriangle triangle;
  float from, to;
};

template <class Visit>
void for_each_meeting(std::uint64_t scenes, const Visit& visit) {
  for_each_hard_case(scenes, [&](const sim::check::HardCase& hard) {
    for (std::size_t i = 0; i < std::min<std::size_t>(hard.rays.size(), 100); ++i) {
      oracle::RayOracle oracle(hard.rays[i]);
      for (std::uint32_t id = 0; id < std::min<std::size_t>(hard.mesh.triangles.size(), 200); ++id) {
        const LeafTriangle t = accel::leaf_record(hard.mesh, id);
        if (!oracle.meets_triangle(t.v0, t.v1, t.v2)) continue;
        const Ray& ray = hard.rays[i];
        const auto hit = oracle::exact_ray_triangle(ray, t.v0, t.v1, t.v2, ray.tmin, ray.tmax);
        if (hit.hit) visit(Meeting{ray, t, hit.t.down, hit.t.up});
      }
    }
  });
}

TEST(RayBox, culling_keeps_every_true_hit) {
  SCOPED_TRACE(oracle::seed_note());
  int meetings = 0;
  for_each_meeting(2, [&](const Meeting& m) {
    const PrimitiveBox primitive = accel::box_of_primitive(m.triangle);
    RayBox tight(m.ray, m.from, m.to), cut(m.ray, m.ray.tmin, m.ray.tmax);
    cut.end_at(m.ray, m.to);
    ASSERT_TRUE(tight.overlaps(primitive)) << show(m.ray);
    ASSERT_TRUE(cut.overlaps(primitive)) << show(m.ray);
    ++meetings;
  });
  EXPECT_GT(meetings, 2000);
}

TEST(RayBox, the_papers_epsilon_loses_hits_of_the_same_cases) {
  int meetings = 0, lost = 0;
  for_each_meeting(1, [&](const Meeting& m) {
    ++meetings;
    lost += !test::EpsilonRayBox(m.ray, m.from, m.to).overlaps(accel::box_of_primitive(m.triangle));
  });
  RecordProperty("meetings", meetings);
  RecordProperty("lost", lost);
  EXPECT_GT(lost, meetings / 1000);
}

TEST(RayBox, the_papers_epsilon_culls_less_in_a_small_scene) {
  // A scene of a millionth of the unit: the epsilon is a hundred times its size.
  const Ray ray{{-1e-6f, 0, 0}, 0, {1, 0, 0}, 2e-6f};
  const PrimitiveBox beside{{-1e-7f, 5e-7f, 0}, {1e-7f, 6e-7f, 1e-7f}};
  EXPECT_TRUE(test::EpsilonRayBox(ray, 0, 2e-6f).overlaps(beside));
  EXPECT_FALSE(RayBox(ray, 0, 2e-6f).overlaps(beside));
}

/// A leaf of unit cubes in a row along x, the ray through all of them or some.
struct Row {
  std::vector<PrimitiveBox> boxes;
  RayBoxCounts counts;
  std::vector<std::uint32_t> tested;
  float best = std::numeric_limits<float>::infinity();

  explicit Row(int cubes) {
    for (int i = 0; i < cubes; ++i) {
      const auto x = static_cast<float>(2 * i);
      boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
    }
  }
  /// `hit_at(i)`: where primitive i is hit, if it is.
  template <class Box, class HitAt>
  void visit(const Ray& ray, float tmin, float tmax, const HitAt& hit_at, bool any_hit = false) {
    cull::visit_leaf<Box>(
        ray, tmin, tmax, static_cast<std::uint32_t>(boxes.size()), best, any_hit,
        [&](std::uint32_t i) -> const PrimitiveBox& { return boxes[i]; },
        [&](std::uint32_t i) {
          tested.push_back(i);
          const std::optional<float> t = hit_at(i);
          if (!t || *t >= best) return false;
          best = *t;
          return true;
        },
        counts);
  }
};

constexpr auto kNoHit = [](std::uint32_t) -> std::optional<float> { return std::nullopt; };
const Ray kAlongX{{0, 0.5f, 0.5f}, 0, {1, 0, 0}, 100};

TEST(LeafCulling, follows_algorithm_1) {
  Row row(5);
  row.visit<RayBox>(kAlongX, 2.5f, 4.5f, kNoHit);  // x from 2.5 to 4.5: cubes 1 and 2
  EXPECT_EQ(row.tested, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(row.counts.created, 1u);
  EXPECT_EQ(row.counts.updated, 0u);
  EXPECT_EQ(row.counts.box_tests, 5u);
  EXPECT_EQ(row.counts.primitive_tests, 2u);
}

TEST(LeafCulling, a_hit_cuts_the_box_unless_it_is_the_last_primitives) {
  Row row(5);
  row.visit<RayBox>(kAlongX, 0, 10, [](std::uint32_t i) -> std::optional<float> { return i == 1 ? 2.0f : 9.0f; });
  EXPECT_EQ(row.tested, (std::vector<std::uint32_t>{0, 1}));  // cube 0 "hit" at 9, cube 1 at 2; then 4 is too far
  EXPECT_EQ(row.counts.updated, 2u);
  Row last(3);
  last.visit<RayBox>(kAlongX, 0, 10, [](std::uint32_t i) -> std::optional<float> {
    return i == 2 ? std::optional<float>(4.0f) : std::nullopt;
  });
  EXPECT_EQ(last.counts.updated, 0u);
  EXPECT_EQ(last.counts.primitive_tests, 3u);
}

TEST(LeafCulling, a_single_primitive_is_tested_without_a_box) {
  Row row(1);
  row.visit<RayBox>(kAlongX, 10, 11, kNoHit);
  EXPECT_EQ(row.tested.size(), 1u);
  EXPECT_EQ(row.counts.created, 0u);
  Row two(2);
  two.visit<RayBox>(kAlongX, 10, 11, kNoHit);
  EXPECT_EQ(two.tested.size(), 0u);
  EXPECT_EQ(two.counts.created, 1u);
  Row plain(5);
  plain.visit<NoRayBox>(kAlongX, 10, 11, kNoHit);
  EXPECT_EQ(plain.tested.size(), 5u);
  EXPECT_EQ(plain.counts.box_tests, 0u);
}

TEST(LeafCulling, a_shadow_ray_ends_at_its_first_hit_and_no_box_is_cut) {
  Row row(5);
  row.visit<RayBox>(
      kAlongX, 0, 10, [](std::uint32_t i) -> std::optional<float> { return static_cast<float>(2 * i); }, true);
  EXPECT_EQ(row.tested.size(), 1u);
  EXPECT_EQ(row.counts.updated, 0u);
}

TEST(LeafCulling, a_hit_behind_the_leaf_does_not_let_the_box_out_of_it) {
  Row row(5);
  row.visit<RayBox>(kAlongX, 0, 3, [](std::uint32_t i) -> std::optional<float> {
    return i == 0 ? std::optional<float>(50.0f) : std::nullopt;
  });
  EXPECT_EQ(row.tested, (std::vector<std::uint32_t>{0, 1}));  // cube 2 begins at 4
}

}  // namespace
}  // namespace ctu::cull
