// Areas are found where the lights are, whatever else is among the rays, and hold the rays that they were found from.
#include "model/influence/find_areas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/base/error.h"
#include "model/influence/light_fit.h"
#include "model/influence/tree_set.h"
#include "model/scene/random.h"
#include "tests/oracle/seed.h"

namespace ctu {
namespace {

using influence::AreaKind;
using influence::FoundAreas;
using influence::InfluenceArea;
using intersect::Ray;
using scene::Vector64;

constexpr Vec3 kLower{-1, -1, -1}, kUpper{1, 1, 1};

class RaySource {
 public:
  explicit RaySource(std::uint64_t seed) : random_(seed, 0) {}
  Vector64 place() { return {random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, 1)}; }
  Vector64 floor() { return {random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, -0.8)}; }
  static Ray ray(const Vector64& from, const Vector64& to) {
    const Vector64 d = to - from;
    return {from.rounded(), 0, normalized(d, {0, 0, 1}).rounded(), static_cast<float>(length(d) * (1 - 0x1p-20)),
            intersect::RayKind::AnyHit};
  }
  void towards(const Vector64& light, int count, std::vector<Ray>& rays, bool from_floor) {
    for (int i = 0; i < count; ++i) rays.push_back(ray(from_floor ? floor() : place(), light));
  }
  void scattered(int count, std::vector<Ray>& rays) {
    for (int i = 0; i < count; ++i) rays.push_back(ray(place(), place()));
  }

 private:
  scene::Random random_;
};

/// The share of the rays that have their whole way in an area they are affine to.
double share_held(const FoundAreas& found, const std::vector<Ray>& rays, std::size_t count) {
  std::size_t held = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bool inside = false;
    for (const auto& one : found.areas) {
      const influence::PreparedArea area(one.area);
      inside = inside || (influence::runs_along(one.area, rays[i], std::cos(0.1)) &&
                          area.certainly_contains(rays[i].origin) && area.certainly_contains(rays[i], rays[i].tmax));
    }
    held += inside ? 1 : 0;
  }
  return double(held) / double(count);
}

double distance(const Vec3& a, const Vector64& b) { return length(Vector64(a) - b); }

TEST(FindAreas, finds_the_focal_point_among_rays_that_run_anywhere) {
  SCOPED_TRACE(oracle::seed_note());
  RaySource source(oracle::test_seed());
  const Vector64 light{0.2, 0.1, 0.9};
  std::vector<Ray> rays;
  source.towards(light, 1500, rays, true);
  source.scattered(1500, rays);
  const FoundAreas found = influence::find_areas(rays, kLower, kUpper);
  ASSERT_GE(found.areas.size(), 1u);
  EXPECT_EQ(found.areas[0].area.kind, AreaKind::Point);
  EXPECT_LT(distance(found.areas[0].area.origin, light), 0.02);
  EXPECT_GT(share_held(found, rays, 1500), 0.99);
  EXPECT_GT(found.unclaimed, 1200u) << "rays that agree with nothing belong to no area";
}

TEST(FindAreas, finds_the_direction_of_a_light_far_away) {
  SCOPED_TRACE(oracle::seed_note());
  RaySource source(oracle::test_seed() + 1);
  const Vector64 direction = scene::normalized({1, 2, 5}, {0, 0, 1});
  std::vector<Ray> rays;
  source.towards(direction * 5000, 1000, rays, false);
  source.scattered(300, rays);
  for (Ray& ray : rays) ray.tmax = std::min(ray.tmax, 0.2f);
  const FoundAreas found = influence::find_areas(rays, kLower, kUpper);
  ASSERT_GE(found.areas.size(), 1u);
  const InfluenceArea& area = found.areas[0].area;
  EXPECT_EQ(area.kind, AreaKind::Plane);
  EXPECT_GT(dot(Vector64(area.axes[2]), direction), std::cos(0.002));
  EXPECT_GT(share_held(found, rays, 1000), 0.99);
}

TEST(FindAreas, gives_a_light_in_the_middle_a_frustum_for_each_side) {
  SCOPED_TRACE(oracle::seed_note());
  RaySource source(oracle::test_seed() + 2);
  std::vector<Ray> rays;
  source.towards({0.05, -0.1, 0.02}, 3000, rays, false);
  const FoundAreas found = influence::find_areas(rays, kLower, kUpper);
  EXPECT_EQ(found.areas.size(), 6u);
  EXPECT_GT(share_held(found, rays, rays.size()), 0.97);
}

TEST(FindAreas, holds_rays_up_to_the_light_that_they_pass) {
  SCOPED_TRACE(oracle::seed_note());
  RaySource source(oracle::test_seed() + 7);
  std::vector<Ray> rays;
  source.towards({0.1, 0.2, 0.3}, 1000, rays, true);
  const double held = share_held(influence::find_areas(rays, kLower, kUpper), rays, rays.size());
  std::vector<Ray> longer = rays;
  for (Ray& ray : longer) ray.tmax = std::numeric_limits<float>::infinity();
  EXPECT_GT(held, 0.99);
  EXPECT_EQ(share_held(influence::find_areas(longer, kLower, kUpper), rays, rays.size()), held);
}

TEST(FindAreas, gives_no_area_to_rays_beyond_what_binary32_can_enclose) {
  RaySource source(oracle::test_seed() + 8);
  std::vector<Ray> rays;
  source.towards({0, 0, 3}, 200, rays, true);
  for (Ray& ray : rays) {
    ray.origin = {ray.origin.x * 3e38f, ray.origin.y * 3e38f, ray.origin.z * 3e38f};
    ray.tmax = std::numeric_limits<float>::infinity();
  }
  constexpr float kLargest = std::numeric_limits<float>::max();
  const FoundAreas found =
      influence::find_areas(rays, {-kLargest, -kLargest, -kLargest}, {kLargest, kLargest, kLargest});
  for (const auto& one : found.areas) EXPECT_EQ(problem_of(one.area), nullptr);
}

TEST(FindAreas, tells_several_lights_apart_most_rays_first) {
  SCOPED_TRACE(oracle::seed_note());
  RaySource source(oracle::test_seed() + 3);
  const Vector64 lights[] = {{-0.8, 0.1, 0.9}, {0.7, 0.6, 0.8}, {0, -0.9, 0.7}};
  std::vector<Ray> rays;
  for (int i = 0; i < 3; ++i) source.towards(lights[i], 1200 - 300 * i, rays, true);
  const FoundAreas found = influence::find_areas(rays, kLower, kUpper);
  ASSERT_EQ(found.areas.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_LT(distance(found.areas[i].area.origin, lights[i]), 0.05) << "light " << i;
  EXPECT_GE(found.areas[0].rays, found.areas[2].rays);
  EXPECT_GT(share_held(found, rays, rays.size()), 0.98);
}

TEST(FindAreas, finds_none_where_there_is_none) {
  RaySource source(oracle::test_seed() + 4);
  std::vector<Ray> rays;
  EXPECT_TRUE(influence::find_areas(rays, kLower, kUpper).areas.empty());
  source.scattered(2000, rays);
  EXPECT_TRUE(influence::find_areas(rays, kLower, kUpper).areas.empty());
  const std::vector<Ray> invalid(10);
  EXPECT_EQ(influence::find_areas(invalid, kLower, kUpper).looked_at, 0u);
}

TEST(FindAreas, is_a_function_of_rays_and_seed) {
  RaySource source(oracle::test_seed() + 5);
  std::vector<Ray> rays;
  source.towards({0, 0, 3}, 500, rays, true);
  source.scattered(500, rays);
  const FoundAreas a = influence::find_areas(rays, kLower, kUpper), b = influence::find_areas(rays, kLower, kUpper);
  ASSERT_EQ(a.areas.size(), b.areas.size());
  for (std::size_t i = 0; i < a.areas.size(); ++i) {
    EXPECT_EQ(a.areas[i].area.origin, b.areas[i].area.origin);
    EXPECT_EQ(a.areas[i].area.far, b.areas[i].area.far);
  }
}

TEST(FindAreas, refuses_options_out_of_range) {
  const std::vector<Ray> rays;
  EXPECT_THROW(influence::find_areas(rays, kLower, kUpper, {.most_areas = -1}), Error);
  EXPECT_THROW(influence::find_areas(rays, kLower, kUpper, {.least_share = 0}), Error);
  EXPECT_THROW(influence::find_areas(rays, kLower, kUpper, {.tolerance_degrees = 90}), Error);
  EXPECT_THROW(influence::find_areas(rays, kLower, kUpper, {.guesses = 0}), Error);
}

TEST(NearestPoint, is_where_lines_cross_and_nowhere_for_parallel_ones) {
  const Vector64 focus{3, -2, 5};
  std::vector<influence::Sight> sights;
  for (const Vector64& o : {Vector64{0, 0, 0}, Vector64{1, 0, 0}, Vector64{0, 1, 0}})
    sights.push_back({o, normalized(focus - o, {0, 0, 1}), focus});
  const std::vector<std::uint32_t> all{0, 1, 2};
  const auto point = influence::nearest_point(sights, all);
  ASSERT_TRUE(point.has_value());
  EXPECT_LT(length(*point - focus), 1e-12);
  for (influence::Sight& sight : sights) sight.direction = {0, 0, 1};
  EXPECT_FALSE(influence::nearest_point(sights, all).has_value());
}

}  // namespace
}  // namespace ctu
