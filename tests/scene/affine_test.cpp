#include "model/scene/affine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/scene/turn.h"

namespace ctu::scene::test {
namespace {

void expect_near(const Vector64& a, const Vector64& b, double tolerance = 1e-14) {
  EXPECT_LE(length(a - b), tolerance);
}

TEST(Turn, agrees_with_libm_and_is_exact_at_quarters) {
  for (int i = -1000; i <= 1000; ++i) {
    const double turns = i * 0.00317;
    const Turn t = turn(turns);
    EXPECT_NEAR(t.cosine, std::cos(turns * 2 * 3.14159265358979323846), 4e-15);
    EXPECT_NEAR(t.sine, std::sin(turns * 2 * 3.14159265358979323846), 4e-15);
  }
  EXPECT_EQ(turn(0.25).cosine, 0);
  EXPECT_EQ(turn(0.25).sine, 1);
  EXPECT_EQ(turn(-0.5).cosine, -1);
  EXPECT_EQ(turn(0.75).sine, -1);
}

TEST(Affine, a_product_acts_with_its_right_factor_first) {
  const Affine a = translation({1, 2, 3}), b = scaling({2, 2, 2});
  expect_near((a * b).point({1, 1, 1}), {3, 4, 5});
  expect_near((b * a).point({1, 1, 1}), {4, 6, 8});
  expect_near((a * b).direction({1, 1, 1}), {2, 2, 2});
}

TEST(Affine, an_inverse_undoes) {
  const Affine a = translation({1, -2, 3}) * *rotation(33, {1, 2, 3}) * scaling({2, -0.5, 4});
  const auto back = inverse(a);
  ASSERT_TRUE(back);
  for (const Vector64& p : {Vector64{0, 0, 0}, Vector64{5, -7, 11}, Vector64{1e-3, 2, -3}})
    expect_near(back->point(a.point(p)), p);
  EXPECT_FALSE(inverse(scaling({1, 0, 1})));
}

TEST(Affine, rotations_are_right_handed_and_agree_with_quaternions) {
  expect_near(rotation(90, {0, 0, 5})->point({1, 0, 0}), {0, 1, 0});
  expect_near(rotation(90, {1, 0, 0})->point({0, 1, 0}), {0, 0, 1});
  expect_near(rotation(120, {1, 1, 1})->point({1, 2, 3}), {3, 1, 2});
  const double half = 50 * 3.14159265358979323846 / 360;
  const std::array<double, 4> q{std::sin(half) * 2 / 3, std::sin(half) / 3, std::sin(half) * 2 / 3, std::cos(half)};
  expect_near(rotation(q)->point({1, 2, 3}), rotation(50, {2, 1, 2})->point({1, 2, 3}));
  EXPECT_FALSE(rotation(10, {0, 0, 0}));
  EXPECT_FALSE(rotation({0, 0, 0, 0}));
}

}  // namespace
}  // namespace ctu::scene::test
