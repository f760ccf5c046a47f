// triangle_test against its own statement, bit for bit.
#include <gtest/gtest.h>

#include "model/intersect/triangle_test.h"
#include "tests/intersect/stated_triangle.h"
#include "tests/intersect/triangle_cases.h"
#include "tests/oracle/seed.h"

namespace ctu::intersect {
namespace {

void expect_stated_bits(double smallest, double largest, int cases) {
  SCOPED_TRACE(oracle::seed_note());
  TriangleCases source(oracle::test_seed());
  int hits = 0;
  for (int i = 0; i < cases; ++i) {
    const TriangleCase c = source.next(source.power_of_ten(smallest, largest));
    const PreparedRay ray = prepare_ray(c.ray);
    if (!ray.valid) continue;
    const TriangleResult is = triangle_test(ray, c.v[0], c.v[1], c.v[2], c.ray.tmax);
    const TriangleResult should = stated_triangle_test(ray, c.v, c.ray.tmax);
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
