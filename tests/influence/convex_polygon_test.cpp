// Hull, point test, overlap and area against rational arithmetic: to the bit on a lattice, within rounding elsewhere.
#include "model/influence/convex_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/influence/exact_area.h"
#include "tests/oracle/seed.h"

namespace ctu {
namespace {

using influence::ConvexPolygon;
using influence::Point2;

class Points {
 public:
  explicit Points(std::uint64_t seed) : random_(seed) {}
  /// Whole coordinates: every product and sum of the tests is exact.
  std::vector<Point2> lattice(int count, int reach) {
    std::uniform_int_distribution<int> whole(-reach, reach);
    std::vector<Point2> points;
    for (int i = 0; i < count; ++i) points.push_back({double(whole(random_)), double(whole(random_))});
    return points;
  }
  std::vector<Point2> anywhere(int count, double reach) {
    std::uniform_real_distribution<double> real(-reach, reach);
    std::vector<Point2> points;
    for (int i = 0; i < count; ++i) points.push_back({real(random_), real(random_)});
    return points;
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

 private:
  std::mt19937_64 random_;
};

std::vector<Point2> vertices(const ConvexPolygon& polygon) {
  return {polygon.vertices().begin(), polygon.vertices().end()};
}

TEST(ConvexPolygon, is_the_hull_of_its_points) {
  SCOPED_TRACE(oracle::seed_note());
  Points points(oracle::test_seed());
  for (int i = 0; i < 2000; ++i) {
    std::vector<Point2> all = points.lattice(points.whole(1, 14), points.whole(1, 9));
    const ConvexPolygon hull = influence::convex_hull(all);
    if (hull.size() < 3) continue;
    for (const Point2& p : all) EXPECT_GE(test::exact_side(vertices(hull), p), 0);
    for (std::size_t k = 0; k < hull.size(); ++k) {
      EXPECT_NE(std::find(all.begin(), all.end(), hull[k]), all.end()) << "a vertex that is no point";
      EXPECT_GT(influence::turn(hull[k], hull[(k + 1) % hull.size()], hull[(k + 2) % hull.size()]), 0)
          << "a vertex too many, or clockwise";
    }
  }
}

TEST(ConvexPolygon, contains_what_is_inside_or_on_the_border) {
  SCOPED_TRACE(oracle::seed_note());
  Points points(oracle::test_seed() + 1);
  int on_border = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<Point2> all = points.lattice(6, 5);
    const ConvexPolygon hull = influence::convex_hull(all);
    if (hull.size() < 3) continue;
    for (const Point2& p : points.lattice(40, 6)) {
      const int side = test::exact_side(vertices(hull), p);
      on_border += side == 0 ? 1 : 0;
      EXPECT_EQ(contains(hull, p), side >= 0);
    }
  }
  EXPECT_GT(on_border, 500);
}

TEST(ConvexPolygon, has_the_area_of_the_shoelace_formula) {
  SCOPED_TRACE(oracle::seed_note());
  Points points(oracle::test_seed() + 2);
  for (int i = 0; i < 1000; ++i) {
    std::vector<Point2> all = points.lattice(9, 1000);
    const ConvexPolygon hull = influence::convex_hull(all);
    EXPECT_EQ(2 * area(hull), test::exact_doubled_area(vertices(hull)));
    std::vector<Point2> far = points.anywhere(9, 1);
    for (Point2& p : far) p.x += 1e6;
    const ConvexPolygon moved = influence::convex_hull(far);
    EXPECT_NEAR(area(moved), test::exact_doubled_area(vertices(moved)) / 2, 1e-14) << "far from the origin";
  }
  EXPECT_EQ(area(ConvexPolygon{}), 0);
}

TEST(ConvexPolygon, overlaps_in_the_area_that_exact_arithmetic_finds) {
  SCOPED_TRACE(oracle::seed_note());
  Points points(oracle::test_seed() + 3);
  int apart = 0, partly = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool lattice = i % 2 == 0;  // shared edges, vertices and borders
    std::vector<Point2> p = lattice ? points.lattice(5, 4) : points.anywhere(8, 1);
    std::vector<Point2> q = lattice ? points.lattice(5, 4) : points.anywhere(6, 1);
    if (i % 4 == 1)
      for (Point2& moved : q) moved.x += 1;
    const ConvexPolygon a = influence::convex_hull(p), b = influence::convex_hull(q);
    if (a.size() < 3 || b.size() < 3) continue;
    const double exact = test::exact_common_area(vertices(a), vertices(b));
    EXPECT_NEAR(area(overlap(a, b)), exact, 1e-13);
    EXPECT_NEAR(area(overlap(b, a)), exact, 1e-13);
    apart += exact == 0 ? 1 : 0;
    partly += exact > 0 && exact < 0.9 * std::min(area(a), area(b)) ? 1 : 0;
  }
  EXPECT_GT(apart, 20);
  EXPECT_GT(partly, 300);
}

}  // namespace
}  // namespace ctu
