// triangle_test against its own statement (the list of roundings at the top of triangle_test.h), done in rationals.
#include <gtest/gtest.h>

#include "model/intersect/triangle_test.h"
#include "tests/intersect/triangle_cases.h"
#include "tests/oracle/rational.h"
#include "tests/oracle/seed.h"

namespace ctu::intersect {
namespace {

using numeric::Round;
using oracle::exact;
using oracle::Rational;

Rational times_power_of_two(const Rational& x, long exponent) {
  Rational result;
  if (exponent >= 0)
    mpq_mul_2exp(result.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  else
    mpq_div_2exp(result.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  return result;
}

/// R(x): 24 bits, to nearest even, any exponent. Binary32's rounding after moving x to about 1.
Rational rounded(const Rational& x) {
  if (x == 0) return x;
  const long exponent =
      static_cast<long>(mpz_sizeinbase(x.get_num_mpz_t(), 2)) - static_cast<long>(mpz_sizeinbase(x.get_den_mpz_t(), 2));
  return times_power_of_two(exact(oracle::round_rational(times_power_of_two(x, -exponent), Round::Nearest)), exponent);
}

float to_binary32(const Rational& x) { return x == 0 ? 0.0f : oracle::round_rational(x, Round::Nearest); }

struct Corner {
  Rational x, y, z;

  Corner(const PreparedRay& ray, const Vec3& vertex) {
    const auto from_origin = [&](int axis) { return rounded(exact(vertex[axis]) - exact(ray.ray.origin[axis])); };
    z = from_origin(ray.kz);
    x = rounded(from_origin(ray.kx) - rounded(exact(ray.sx) * z));
    y = rounded(from_origin(ray.ky) - rounded(exact(ray.sy) * z));
  }
};

TriangleResult stated(const PreparedRay& ray, const Vec3 (&v)[3], float tmax) {
  const Corner a(ray, v[0]), b(ray, v[1]), c(ray, v[2]);
  const Rational u = rounded(c.x * b.y - c.y * b.x), w_of_b = rounded(a.x * c.y - a.y * c.x),
                 w = rounded(b.x * a.y - b.y * a.x);
  const bool negative = u < 0 || w_of_b < 0 || w<0, positive = u> 0 || w_of_b > 0 || w > 0;
  if (negative && positive) return {};
  const Rational det = rounded(rounded(u + w_of_b) + w);
  if (det == 0) return {};
  const Rational depth = rounded(rounded(rounded(u * a.z) + rounded(w_of_b * b.z)) + rounded(w * c.z));
  const Rational scaled = rounded(det * exact(ray.ray.direction[ray.kz]));
  const float t = to_binary32(depth / scaled);
  if (!(ray.ray.tmin <= t && t <= tmax)) return {};
  return {true, t, to_binary32(w_of_b / det), to_binary32(w / det)};
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
