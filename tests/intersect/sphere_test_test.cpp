// sphere_test against its own statement, bit for bit, and against exact arithmetic.
#include "model/intersect/sphere_test.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/intersect/sphere_cases.h"
#include "tests/oracle/exact_sphere.h"
#include "tests/oracle/rational.h"
#include "tests/oracle/seed.h"

namespace ctu::intersect {
namespace {

using oracle::exact;
using oracle::operator-;
using oracle::Rational;
using oracle::round24;
using Stated3 = std::array<Rational, 3>;

Rational stated_dot(const Stated3& a, const Stated3& b) {
  return round24(round24(round24(a[0] * b[0]) + round24(a[1] * b[1])) + round24(a[2] * b[2]));
}

/// The square root to 24 bits, to nearest: the integer root of the number scaled to 48 or 49 bits, no tie can occur.
Rational stated_root(const Rational& x) {
  if (x == 0) return 0;
  int exponent = 0;
  Rational scaled = x;
  const Rational low = Rational(mpz_class(1) << 50);
  while (scaled < low) scaled *= 4, --exponent;
  while (scaled >= 4 * low) scaled /= 4, ++exponent;
  const mpz_class whole = scaled.get_num() / scaled.get_den();
  mpz_class root = sqrt(whole);
  // Below the last place a remainder only needs to be seen.
  Rational value(root);
  if (value * value != scaled) value += Rational(1, 4);
  for (; exponent > 0; --exponent) value *= 2;
  for (; exponent < 0; ++exponent) value /= 2;
  return round24(value);
}

SphereResult stated_sphere_test(const Ray& ray, const scene::Sphere& sphere, float tmax) {
  Stated3 f, d, l;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    f[i] = round24(exact(ray.origin[axis]) - exact(sphere.centre[axis]));
    d[i] = exact(ray.direction[axis]);
  }
  const Rational a = stated_dot(d, d), s = -round24(stated_dot(f, d) / a);
  for (std::size_t i = 0; i < 3; ++i) l[i] = round24(f[i] + round24(s * d[i]));
  const Rational delta = round24(round24(exact(sphere.radius) * exact(sphere.radius)) - stated_dot(l, l));
  if (delta < 0) return {};
  const Rational h = stated_root(round24(delta / a));
  for (const Rational& at : {Rational(s - h), Rational(s + h)}) {
    const float t = oracle::quotient_binary32(round24(at));
    if (ray.tmin <= t) return t <= tmax ? SphereResult{true, t} : SphereResult{};
  }
  return {};
}

void expect_stated_bits(double smallest, double largest, int cases) {
  SCOPED_TRACE(oracle::seed_note());
  SphereCases source(oracle::test_seed());
  int hits = 0;
  for (int i = 0; i < cases; ++i) {
    const SphereCase c = source.next(source.power_of_ten(smallest, largest));
    const PreparedRay ray = prepare_ray(c.ray);
    if (!ray.valid) continue;
    const SphereResult is = sphere_test(ray, c.sphere, c.ray.tmax);
    const SphereResult should = stated_sphere_test(c.ray, c.sphere, c.ray.tmax);
    ASSERT_EQ(is.hit, should.hit) << show(c);
    ASSERT_EQ(numeric::bits(is.t), numeric::bits(should.t)) << show(c);
    hits += is.hit;
  }
  EXPECT_GT(hits, cases / 10);
}

TEST(SphereTest, gives_the_bits_of_its_statement_at_ordinary_sizes) { expect_stated_bits(-3, 3, 10'000); }
TEST(SphereTest, gives_the_bits_of_its_statement_where_binary32_products_underflow) {
  expect_stated_bits(-30, -15, 5'000);
}
TEST(SphereTest, gives_the_bits_of_its_statement_among_subnormals) { expect_stated_bits(-44, -37, 5'000); }
TEST(SphereTest, gives_the_bits_of_its_statement_where_binary32_products_overflow) {
  expect_stated_bits(18, 34, 5'000);
}

/// Of the documented errors: |o - c| and r in one number, in binary64 where its own error does not matter.
struct Tolerance {
  double from_centre = 0, silhouette = 0, along = 0;

  explicit Tolerance(const SphereCase& c) {
    constexpr double kUnit = 0x1p-24;
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double f = static_cast<double>(c.ray.origin[axis]) - c.sphere.centre[axis];
      square += f * f;
    }
    from_centre = std::sqrt(square);
    silhouette = kUnit * (12 * from_centre + 2 * static_cast<double>(c.sphere.radius));
    along = kUnit * (24 * from_centre + 8 * static_cast<double>(c.sphere.radius));
  }
};

/// How far the line passes from the centre, to nearly twice binary64: the squares cancel.
double passing_distance(const SphereCase& c) {
  oracle::Vec3q f = exact(c.ray.origin) - exact(c.sphere.centre);
  const oracle::Vec3q d = exact(c.ray.direction);
  const oracle::Vec3q across = oracle::cross(f, d);
  const Rational square = oracle::dot(across, across) / oracle::dot(d, d);
  return std::sqrt(square.get_d());
}

TEST(SphereTest, decides_as_exact_arithmetic_but_at_the_silhouette_and_at_the_ends_of_the_ray) {
  SCOPED_TRACE(oracle::seed_note());
  SphereCases source(oracle::test_seed() + 1);
  int decided = 0, hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const SphereCase c = source.next(source.power_of_ten(-3, 3));
    const PreparedRay ray = prepare_ray(c.ray);
    if (!ray.valid) continue;
    const Tolerance tolerance(c);
    if (std::fabs(passing_distance(c) - static_cast<double>(c.sphere.radius)) <= tolerance.silhouette * 1.001) continue;
    const SphereResult is = sphere_test(ray, c.sphere, c.ray.tmax);
    const oracle::ExactSphereHit should =
        oracle::exact_ray_sphere(c.ray, c.sphere.centre, c.sphere.radius, c.ray.tmin, c.ray.tmax);
    // A surface point at an end of the ray may fall on its other side.
    double speed = 0;
    for (int axis = 0; axis < 3; ++axis) speed += static_cast<double>(c.ray.direction[axis]) * c.ray.direction[axis];
    speed = std::sqrt(speed);
    const auto surface_near = [&](float t) {
      if (!std::isfinite(t)) return false;
      double square = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double x = static_cast<double>(c.ray.origin[axis]) + static_cast<double>(t) * c.ray.direction[axis] -
                         c.sphere.centre[axis];
        square += x * x;
      }
      return std::fabs(std::sqrt(square) - static_cast<double>(c.sphere.radius)) <= 2 * tolerance.along;
    };
    if (surface_near(c.ray.tmin) || surface_near(c.ray.tmax)) continue;
    ++decided;
    hits += should.hit;
    ASSERT_EQ(is.hit, should.hit) << show(c);
  }
  EXPECT_GT(decided, 12'000);
  EXPECT_GT(hits, 4'000);
}

TEST(SphereTest, its_point_lies_on_the_sphere_to_the_stated_error) {
  SCOPED_TRACE(oracle::seed_note());
  SphereCases source(oracle::test_seed() + 2);
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const SphereCase c = source.next(source.power_of_ten(-3, 3));
    const PreparedRay ray = prepare_ray(c.ray);
    const SphereResult is = ray.valid ? sphere_test(ray, c.sphere, c.ray.tmax) : SphereResult{};
    if (!is.hit) continue;
    ++hits;
    Rational square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Rational x =
          exact(c.ray.origin[axis]) + exact(is.t) * exact(c.ray.direction[axis]) - exact(c.sphere.centre[axis]);
      square += x * x;
    }
    const double off = std::fabs(std::sqrt(square.get_d()) - static_cast<double>(c.sphere.radius));
    ASSERT_LE(off, Tolerance(c).along * 1.001) << show(c);
  }
  EXPECT_GT(hits, 5'000);
}

TEST(SphereTest, both_sides_of_the_surface_are_hit_and_the_inside_is_not) {
  const scene::Sphere unit{{0, 0, 0}, 1};
  const auto test = [&](float from, float tmin, float tmax) {
    return sphere_test(prepare_ray({{from, 0, 0}, tmin, {1, 0, 0}, tmax}), unit, tmax);
  };
  EXPECT_EQ(test(-3, 0, 10).t, 2);
  EXPECT_EQ(test(0, 0, 10).t, 1);       // from inside: where it leaves
  EXPECT_EQ(test(-3, 2.5f, 10).t, 4);   // the first surface point is before tmin
  EXPECT_EQ(test(-3, 2, 10).t, 2);      // tmin itself belongs to the ray
  EXPECT_TRUE(test(-3, 0, 2).hit);      // and so does tmax
  EXPECT_FALSE(test(-0.5f, 0, 1).hit);  // all of it inside
  EXPECT_FALSE(test(3, 0, 10).hit);     // behind
  EXPECT_FALSE(test(-3, 0, 1.5f).hit);
}

TEST(SphereTest, a_tangent_and_a_point_are_hit_where_no_rounding_takes_part) {
  EXPECT_EQ(sphere_test(prepare_ray({{-3, 1, 0}, 0, {1, 0, 0}, 10}), {{0, 0, 0}, 1}, 10).t, 3);
  EXPECT_EQ(sphere_test(prepare_ray({{-3, 2, 0}, 0, {1, 0, 0}, 10}), {{0, 2, 0}, 0}, 10).t, 3);
  EXPECT_FALSE(sphere_test(prepare_ray({{-3, 2, 0}, 0, {1, 0, 0}, 10}), {{0, 2.0000002f, 0}, 0}, 10).hit);
}

}  // namespace
}  // namespace ctu::intersect
