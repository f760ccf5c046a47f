#include "model/intersect/triangle_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/intersect/triangle_cases.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/seed.h"

namespace ctu::intersect {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TriangleResult test(const TriangleCase& c) {
  return triangle_test(prepare_ray(c.ray), c.v[0], c.v[1], c.v[2], c.ray.tmax);
}

TriangleCase facing_triangle() {
  TriangleCase c;
  c.v[0] = {0, 0, 2}, c.v[1] = {4, 0, 2}, c.v[2] = {0, 4, 2};
  c.ray.origin = {1, 2, -2};
  c.ray.direction = {0, 0, 2};
  c.ray.tmax = kInfinity;
  return c;
}

TEST(TriangleTest, a_known_hit_has_its_distance_and_barycentrics_exactly) {
  const TriangleResult r = test(facing_triangle());
  ASSERT_TRUE(r.hit);
  EXPECT_EQ(r.t, 2.0f);
  EXPECT_EQ(r.u, 0.25f);
  EXPECT_EQ(r.v, 0.5f);
}

TEST(TriangleTest, both_faces_are_hit) {
  TriangleCase c = facing_triangle();
  std::swap(c.v[1], c.v[2]);
  const TriangleResult r = test(c);
  ASSERT_TRUE(r.hit);
  EXPECT_EQ(r.t, 2.0f);
  EXPECT_EQ(r.u, 0.5f);
  EXPECT_EQ(r.v, 0.25f);
}

TEST(TriangleTest, edges_and_vertices_belong_to_the_triangle) {
  TriangleCase c = facing_triangle();
  for (const Vec3& at : {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}, Vec3{2, 0, 0}, Vec3{0, 3, 0}, Vec3{1, 3, 0}}) {
    c.ray.origin = at;
    EXPECT_TRUE(test(c).hit) << at.x << " " << at.y;
  }
  for (const Vec3& at : {Vec3{-0x1p-140f, 0, 0}, Vec3{0, -0x1p-140f, 0}, Vec3{2, numeric::next_up(2), 0}}) {
    c.ray.origin = at;
    EXPECT_FALSE(test(c).hit) << at.x << " " << at.y;
  }
}

TEST(TriangleTest, the_ends_of_the_interval_belong_to_it) {
  TriangleCase c = facing_triangle();
  c.ray.tmin = c.ray.tmax = 2;
  EXPECT_TRUE(test(c).hit);
  c.ray.tmax = numeric::next_down(2);
  c.ray.tmin = 0;
  EXPECT_FALSE(test(c).hit);
  c.ray.tmax = kInfinity;
  c.ray.tmin = numeric::next_up(2);
  EXPECT_FALSE(test(c).hit);
  c.ray.tmin = 0;
  c.ray.origin.z = 3;
  EXPECT_FALSE(test(c).hit) << "behind the origin";
}

TEST(TriangleTest, triangles_seen_edge_on_or_without_area_are_missed) {
  TriangleCase c = facing_triangle();
  c.ray.origin = {-1, 1, 2};
  c.ray.direction = {1, 0, 0};
  EXPECT_FALSE(test(c).hit);
  c = facing_triangle();
  c.v[2] = c.v[1];
  c.ray.origin = {2, 0, 0};
  EXPECT_FALSE(test(c).hit);
  c.v[1] = c.v[2] = c.v[0];
  c.ray.origin = {0, 0, 0};
  EXPECT_FALSE(test(c).hit);
}

TEST(TriangleTest, a_hit_at_distance_zero_is_plus_zero) {
  TriangleCase c = facing_triangle();
  c.ray.origin.z = 2;
  for (const float direction : {2.0f, -2.0f}) {
    c.ray.direction.z = direction;
    const TriangleResult r = test(c);
    ASSERT_TRUE(r.hit);
    EXPECT_EQ(numeric::bits(r.t), 0u);
  }
}

// Wide exponents: everything inside scales exactly, so only t knows the size of the scene or of the direction.
TEST(TriangleTest, scaling_by_powers_of_two_changes_nothing_but_t) {
  SCOPED_TRACE(oracle::seed_note());
  TriangleCases source(oracle::test_seed());
  for (int i = 0; i < 200'000; ++i) {
    const TriangleCase c = source.next(1);
    const TriangleResult r = test(c);
    const int scene = static_cast<int>(source.uniform(-60, 60)), direction = static_cast<int>(source.uniform(-30, 30));
    TriangleCase scaled = c;
    bool exact = true;
    const auto scale = [&](float& x, int power) {
      const float to = std::ldexp(x, power);
      exact = exact && std::ldexp(to, -power) == x;
      x = to;
    };
    for (int axis = 0; axis < 3; ++axis) {
      for (Vec3& v : scaled.v) scale(v[axis], scene);
      scale(scaled.ray.origin[axis], scene);
      scale(scaled.ray.direction[axis], direction);
    }
    const float t = std::ldexp(r.t, scene - direction);
    if (!exact || (t != 0 && std::fabs(t) < 0x1p-120f)) continue;
    const TriangleResult s = test(scaled);
    ASSERT_EQ(s.hit, r.hit) << show(c);
    if (!r.hit) continue;
    ASSERT_EQ(numeric::bits(s.t), numeric::bits(t)) << show(c);
    ASSERT_EQ(numeric::bits(s.u), numeric::bits(r.u)) << show(c);
    ASSERT_EQ(numeric::bits(s.v), numeric::bits(r.v)) << show(c);
  }
}

// Where the ray passes the edges by more than rounding can move it, exact geometry decides.
TEST(TriangleTest, agrees_with_exact_geometry_away_from_edges) {
  SCOPED_TRACE(oracle::seed_note());
  TriangleCases source(oracle::test_seed());
  constexpr double kMargin = 1e-3;
  int compared = 0;
  for (int i = 0; i < 30'000; ++i) {
    TriangleCase c = source.next(1);
    const Vec3 &o = c.ray.origin, &d = c.ray.direction;
    c.ray.tmin = -1e30f;  // the whole line: the sign of t is not what is judged here
    const PreparedRay ray = prepare_ray(c.ray);
    if (!ray.valid || std::fabs(o.x) + std::fabs(o.y) + std::fabs(o.z) > 10) continue;
    const oracle::ExactTriangleHit exact =
        oracle::exact_ray_triangle(c.ray, c.v[0], c.v[1], c.v[2], c.ray.tmin, c.ray.tmax);
    const TriangleResult r = test(c);
    if (!exact.hit || exact.edge_on) continue;
    const double w = 1 - exact.u - exact.v,
                 length = std::sqrt(double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z);
    if (std::min({exact.u, exact.v, w}) < kMargin || !r.hit) {
      EXPECT_LT(std::min({exact.u, exact.v, w}), kMargin * 50) << "a hit well inside was missed" << show(c);
      continue;
    }
    // The barycentrics are worth what they are on thin or grazing triangles too: the point they name is on the ray.
    for (int axis = 0; axis < 3; ++axis) {
      const double on_triangle =
          (1.0 - r.u - r.v) * c.v[0][axis] + double(r.u) * c.v[1][axis] + double(r.v) * c.v[2][axis];
      const double on_ray = o[axis] + double(r.t) * d[axis];
      EXPECT_NEAR(on_triangle, on_ray, 1e-5 * (1 + length * std::fabs(r.t))) << show(c);
    }
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

TEST(TriangleTest, subnormal_directions_and_huge_coordinates_are_ordinary) {
  TriangleCase c = facing_triangle();
  c.ray.direction = {0, 0, numeric::from_bits(4)};  // 4 x 2^-149
  EXPECT_FALSE(test(c).hit && std::isfinite(test(c).t)) << "t = 2^149 is beyond binary32";
  for (Vec3& v : c.v) v.x *= 0x1p-140f, v.y *= 0x1p-140f, v.z *= 0x1p-140f;
  c.ray.origin = {0x1p-140f, 0x1p-139f, -0x1p-139f};
  TriangleResult r = test(c);
  ASSERT_TRUE(r.hit);
  EXPECT_EQ(r.t, 512.0f);
  EXPECT_EQ(r.u, 0.25f);

  const float far = 0x1.8p127f;  // differences of such numbers overflow binary32
  c = facing_triangle();
  c.v[0] = {-far, -far, far}, c.v[1] = {far, -far, far}, c.v[2] = {-far, far, far};
  c.ray.origin = {-0x1p126f, -0x1p126f, -far};
  c.ray.direction = {0, 0, 0x1p126f};
  r = test(c);
  ASSERT_TRUE(r.hit);
  EXPECT_EQ(r.t, 6.0f);
}

}  // namespace
}  // namespace ctu::intersect
