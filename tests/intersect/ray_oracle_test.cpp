// The fast oracle says what rationals say, on every kind of input: that is all it is for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <random>

#include "tests/intersect/triangle_cases.h"
#include "tests/oracle/exact_box.h"
#include "tests/oracle/exact_sphere.h"
#include "tests/oracle/exact_sum.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/ray_oracle.h"
#include "tests/oracle/seed.h"

namespace ctu::oracle {
namespace {

using intersect::Ray;
using intersect::show;
using intersect::TriangleCase;
using numeric::from_bits;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kMost = std::numeric_limits<float>::max();
constexpr float kLeast = std::numeric_limits<float>::denorm_min();

/// Rays, triangles, boxes and spheres of four kinds: at any scale and aimed; on a small lattice, where everything
/// touches; of the numbers at the ends of binary32; and the first two moved by one place.
class Cases {
 public:
  explicit Cases(std::uint64_t seed) : source_(seed), random_(seed + 1) {}

  TriangleCase next(int i) {
    TriangleCase c;
    if (i % 4 == 0) {
      c = source_.next(source_.power_of_ten(-38, 34));
    } else {
      const auto coordinate = [&] { return i % 4 == 1 ? extreme() : lattice(); };
      for (int axis = 0; axis < 3; ++axis) {
        c.ray.origin[axis] = coordinate();
        c.ray.direction[axis] = coordinate();
        for (Vec3& v : c.v) v[axis] = coordinate();
      }
      if (i % 4 == 3) move(c.v[random_() % 3]), move(c.ray.origin);
    }
    choose_range(c.ray);
    if (!intersect::is_valid(c.ray)) c.ray.direction = {0, -1, 0};
    return c;
  }
  float lattice() { return static_cast<float>(static_cast<int>(random_() % 9) - 4); }

 private:
  float extreme() {
    constexpr float kValues[] = {0, kLeast, 3 * kLeast, 0x1p-126f, 1e-30f, 0.1f, 1, 3, 1e30f, kMost / 3, kMost};
    const float value = kValues[random_() % std::size(kValues)];
    return random_() % 2 == 0 ? value : -value;
  }
  void move(Vec3& v) {
    float& x = v[static_cast<int>(random_() % 3)];
    x = random_() % 2 == 0 ? numeric::next_up(x) : numeric::next_down(x);
    if (!std::isfinite(x)) x = kMost;
  }
  void choose_range(Ray& ray) {
    constexpr float kTimes[] = {-kMost, -1, -0.0f, 0, kLeast, 0.25f, 0.5f, 1, 2, 3, kMost, kInfinity};
    ray.tmin = kTimes[random_() % (std::size(kTimes) - 1)];
    ray.tmax = kTimes[random_() % std::size(kTimes)];
    if (random_() % 3 == 0 || !(ray.tmin <= ray.tmax)) ray.tmin = 0, ray.tmax = random_() % 4 == 0 ? 1 : kInfinity;
  }

  intersect::TriangleCases source_;
  std::mt19937_64 random_;
};

struct Tally {
  OracleCounts counts;
  int met = 0;
  void print(const char* what) const {
    std::printf("%s: %llu asked, %d met, %.2f %% by exact sums, %.2f %% by rationals (%s)\n", what,
                static_cast<unsigned long long>(counts.asked), met,
                100.0 * static_cast<double>(counts.summed) / static_cast<double>(counts.asked),
                100.0 * static_cast<double>(counts.rational) / static_cast<double>(counts.asked), seed_note().c_str());
  }
};

std::string show_range(const TriangleCase& c) {
  return show(c) + "\nt in [" + std::to_string(c.ray.tmin) + ", " + std::to_string(c.ray.tmax) + "]";
}

TEST(ExactSum, cancels_to_the_last_bit) {
  ExactSum sum;
  for (const double x : {1e300, 1.0, 0x1p-500, -1e300, -1.0}) sum.add(x);
  EXPECT_EQ(sum.sign(), 1);
  sum.add(-0x1p-500);
  EXPECT_EQ(sum.sign(), 0);
  const double a = 1 + 0x1p-40, b = 1 - 0x1p-41;
  sum.add_product(a, a);
  sum.add_product(-a, b);
  sum.add_product(-a, 0x1p-40);
  sum.add_product(-a, 0x1p-41);
  EXPECT_EQ(sum.sign(), 0);
}

TEST(RayOracle, triangles_are_met_as_rationals_say) {
  SCOPED_TRACE(seed_note());
  Cases cases(test_seed());
  Tally tally;
  for (int i = 0; i < 150'000; ++i) {
    const TriangleCase c = cases.next(i);
    RayOracle oracle(c.ray);
    const bool met = oracle.meets_triangle(c.v[0], c.v[1], c.v[2]);
    ASSERT_EQ(met, exact_ray_triangle(c.ray, c.v[0], c.v[1], c.v[2], c.ray.tmin, c.ray.tmax).hit) << show_range(c);
    tally.counts += oracle.counts();
    tally.met += met;
  }
  EXPECT_GT(tally.met, 5'000);
  tally.print("triangles");
}

TEST(RayOracle, rays_in_planes_of_triangles_and_triangles_without_area) {
  SCOPED_TRACE(seed_note());
  Cases cases(test_seed() + 4);
  int met = 0;
  for (int i = 0; i < 80'000; ++i) {
    TriangleCase c = cases.next(4 * i + 2);
    const int flat = i % 3, other = (i + 1) % 3;
    c.ray.origin[flat] = c.v[0][flat] = c.v[1][flat] = c.v[2][flat] = 2;
    c.ray.direction[flat] = 0;
    if (i % 7 == 0) c.v[2] = c.v[i / 7 % 2];
    if (i % 11 == 0) c.v[0][other] = c.v[1][other] = c.v[2][other] = c.ray.origin[other];
    if (i % 13 == 0) c.ray.direction[other] = 0;
    if (!intersect::is_valid(c.ray)) continue;
    RayOracle oracle(c.ray);
    const bool is_met = oracle.meets_triangle(c.v[0], c.v[1], c.v[2]);
    ASSERT_EQ(is_met, exact_ray_triangle(c.ray, c.v[0], c.v[1], c.v[2], c.ray.tmin, c.ray.tmax).hit) << show_range(c);
    ASSERT_EQ(oracle.counts().rational, 0u);
    met += is_met;
  }
  EXPECT_GT(met, 15'000);
}

TEST(RayOracle, boxes_are_met_as_rationals_say) {
  SCOPED_TRACE(seed_note());
  Cases cases(test_seed() + 1);
  Tally tally;
  for (int i = 0; i < 300'000; ++i) {
    const TriangleCase c = cases.next(i);
    Vec3 lo = c.v[0], hi = c.v[1];
    for (int axis = 0; axis < 3; ++axis)
      if (!(lo[axis] <= hi[axis])) std::swap(lo[axis], hi[axis]);
    RayOracle oracle(c.ray);
    const bool met = oracle.meets_box(lo, hi);
    ASSERT_EQ(met, exact_ray_hits_box(c.ray, lo, hi, c.ray.tmin, c.ray.tmax)) << show_range(c);
    tally.counts += oracle.counts();
    tally.met += met;
  }
  EXPECT_GT(tally.met, 10'000);
  EXPECT_GT(tally.counts.summed, 100u);
  tally.print("boxes");
}

TEST(RayOracle, spheres_are_met_as_rationals_say) {
  SCOPED_TRACE(seed_note());
  Cases cases(test_seed() + 2);
  Tally tally;
  for (int i = 0; i < 50'000; ++i) {
    const TriangleCase c = cases.next(i);
    const float radius = i % 7 == 0 ? 0 : i % 2 == 0 ? c.v[1].x : cases.lattice();
    RayOracle oracle(c.ray);
    const bool met = oracle.meets_sphere(c.v[0], radius);
    ASSERT_EQ(met, exact_ray_sphere(c.ray, c.v[0], radius, c.ray.tmin, c.ray.tmax).hit)
        << show_range(c) << "\nradius " << radius;
    tally.counts += oracle.counts();
    tally.met += met;
  }
  EXPECT_GT(tally.met, 2'000);
  tally.print("spheres");
}

TEST(ExactSphere, first_point_of_the_surface_in_the_range) {
  Ray ray;
  ray.origin = {-3, 0, 0};
  ray.direction = {1, 0, 0};
  const auto at = [&](float tmin, float tmax) { return exact_ray_sphere(ray, {0, 0, 0}, 1, tmin, tmax); };
  EXPECT_EQ(at(0, kInfinity).t.down, 2.0f);
  EXPECT_EQ(at(2.5f, kInfinity).t.up, 4.0f) << "from the inside";
  EXPECT_EQ(at(4, kInfinity).t.down, 4.0f);
  EXPECT_FALSE(at(2.5f, 3.5f).hit) << "inside the ball there is no surface";
  EXPECT_FALSE(at(4.5f, kInfinity).hit);
  ray.origin = {-3, 1, 0};
  EXPECT_EQ(at(0, kInfinity).t.up, 3.0f) << "touches";
  ray.origin = {-3, numeric::next_up(1.0f), 0};
  EXPECT_FALSE(at(0, kInfinity).hit);
  ray.origin = {-3, 0.5f, 0};
  const ExactSphereHit hit = at(0, kInfinity);
  EXPECT_EQ(numeric::next_up(hit.t.down), hit.t.up) << "3 - sqrt(3)/2 is no binary32 number";
  EXPECT_NEAR(hit.t.up, 2.1339746, 1e-6);
}

TEST(ExactSphere, a_met_sphere_has_its_box_met_no_later) {
  SCOPED_TRACE(seed_note());
  Cases cases(test_seed() + 3);
  int met = 0;
  for (int i = 2; i < 40'000; i += 4) {  // on the lattice, where the sphere's box is exact
    const TriangleCase c = cases.next(i);
    const float radius = std::fabs(c.v[1].x);
    const ExactSphereHit hit = exact_ray_sphere(c.ray, c.v[0], radius, c.ray.tmin, c.ray.tmax);
    if (!hit.hit) continue;
    ++met;
    const Vec3 &m = c.v[0], lo{m.x - radius, m.y - radius, m.z - radius}, hi{m.x + radius, m.y + radius, m.z + radius};
    const ExactBoxSpan span = exact_box_span(c.ray, lo, hi, c.ray.tmin, c.ray.tmax);
    ASSERT_TRUE(span.hit) << show_range(c);
    ASSERT_LE(span.entry.down, hit.t.up) << show_range(c);
    ASSERT_GE(span.exit.up, hit.t.down) << show_range(c);
  }
  EXPECT_GT(met, 1'000);
}

}  // namespace
}  // namespace ctu::oracle
