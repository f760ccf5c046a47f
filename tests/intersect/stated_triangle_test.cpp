// triangle_test against its own statement (the list of roundings at the top of triangle_test.h), done in rationals.
#include <gtest/gtest.h>

#include "model/intersect/triangle_test.h"
#include "tests/intersect/triangle_cases.h"
#include "tests/oracle/rational.h"
#include "tests/oracle/seed.h"

namespace ctu::intersect {
namespace {

using oracle::exact;
using oracle::quotient_binary32;
using oracle::Rational;
using oracle::round24;

struct Corner {
  Rational x, y, z;

  Corner(const PreparedRay& ray, const Vec3& vertex) {
    const auto from_origin = [&](int axis) { return round24(exact(vertex[axis]) - exact(ray.ray.origin[axis])); };
    z = from_origin(ray.kz);
    x = round24(from_origin(ray.kx) - round24(exact(ray.sx) * z));
    y = round24(from_origin(ray.ky) - round24(exact(ray.sy) * z));
  }
};

TriangleResult stated(const PreparedRay& ray, const Vec3 (&v)[3], float tmax) {
  const Corner a(ray, v[0]), b(ray, v[1]), c(ray, v[2]);
  const Rational u = round24(c.x * b.y - c.y * b.x), w_of_b = round24(a.x * c.y - a.y * c.x),
                 w = round24(b.x * a.y - b.y * a.x);
  const bool negative = u < 0 || w_of_b < 0 || w<0, positive = u> 0 || w_of_b > 0 || w > 0;
  if (negative && positive) return {};
  const Rational det = round24(round24(u + w_of_b) + w);
  if (det == 0) return {};
  const Rational depth = round24(round24(round24(u * a.z) + round24(w_of_b * b.z)) + round24(w * c.z));
  const Rational scaled = round24(det * exact(ray.ray.direction[ray.kz]));
  const float t = quotient_binary32(depth / scaled);
  if (!(ray.ray.tmin <= t && t <= tmax)) return {};
  return {true, t, quotient_binary32(w_of_b / det), quotient_binary32(w / det)};
}

void expect_stated_bits(double smallest, double largest, int cases) {
  SCOPED_TRACE(oracle::seed_note());
  TriangleCases source(oracle::test_seed());
  int hits = 0;
  for (int i = 0; i < cases; ++i) {
    const TriangleCase c = source.next(source.power_of_ten(smallest, largest));
    const PreparedRay ray = prepare_ray(c.ray);
    if (!ray.valid) continue;
    const TriangleResult is = triangle_test(ray, c.v[0], c.v[1], c.v[2], c.ray.tmax);
    const TriangleResult should = stated(ray, c.v, c.ray.tmax);
    ASSERT_EQ(is.hit, should.hit) << show(c);
    ASSERT_EQ(numeric::bits(is.t), numeric::bits(should.t)) << show(c);
    ASSERT_EQ(numeric::bits(is.u), numeric::bits(should.u)) << show(c);
    ASSERT_EQ(numeric::bits(is.v), numeric::bits(should.v)) << show(c);
    hits += is.hit;
  }
  EXPECT_GT(hits, cases / 10);
}

TEST(TriangleTest, gives_the_bits_of_its_statement_at_ordinary_sizes) { expect_stated_bits(-3, 3, 15'000); }
TEST(TriangleTest, gives_the_bits_of_its_statement_where_binary32_products_begin_to_underflow) {
  expect_stated_bits(-28, -10, 15'000);
}
TEST(TriangleTest, gives_the_bits_of_its_statement_among_subnormals) { expect_stated_bits(-44, -36, 15'000); }
TEST(TriangleTest, gives_the_bits_of_its_statement_near_the_largest_numbers) { expect_stated_bits(30, 34, 15'000); }

}  // namespace
}  // namespace ctu::intersect
