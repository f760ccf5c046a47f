// The oracle is judged by geometry known in closed form, and by its own parts agreeing.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "tests/intersect/triangle_cases.h"
#include "tests/oracle/exact_box.h"
#include "tests/oracle/exact_cells.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/seed.h"

namespace ctu::oracle {
namespace {

using intersect::Ray;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Ray ray_of(const Vec3& origin, const Vec3& direction) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  ray.tmax = kInfinity;
  return ray;
}

int count(const std::vector<std::uint8_t>& cells) { return std::accumulate(cells.begin(), cells.end(), 0); }

std::size_t cell(int x, int y, int z, int r) { return static_cast<std::size_t>(x + r * (y + r * z)); }

TEST(ExactBox, known_spans_and_touches) {
  const Ray ray = ray_of({-1, 0.5f, 0.5f}, {3, 0, 0});
  const ExactBoxSpan span = exact_box_span(ray, {0, 0, 0}, {1, 1, 1}, 0, kInfinity);
  ASSERT_TRUE(span.hit);
  EXPECT_LT(span.entry.down, span.entry.up) << "1/3 is no binary32 number";
  EXPECT_EQ(numeric::next_up(span.entry.down), span.entry.up);
  EXPECT_NEAR(span.exit.up, 2.0 / 3.0, 1e-7);
  EXPECT_TRUE(exact_ray_hits_box(ray_of({-1, 1, 1}, {1, 0, 0}), {0, 0, 0}, {1, 1, 1}, 0, 1))
      << "touches an edge at tmax";
  EXPECT_FALSE(exact_ray_hits_box(ray_of({-1, 1, 1}, {1, 0, 0}), {0, 0, 0}, {1, 1, 1}, 0, 0.99f));
  EXPECT_FALSE(exact_ray_hits_box(ray_of({-1, numeric::next_up(1), 1}, {1, 0, 0}), {0, 0, 0}, {1, 1, 1}, 0, 9));
}

TEST(ExactTriangle, finds_hits_on_all_shapes) {
  const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
  const ExactTriangleHit inside = exact_ray_triangle(ray_of({1, 1, 3}, {0, 0, -1}), a, b, c, 0, kInfinity);
  EXPECT_TRUE(inside.hit && !inside.on_edge && !inside.edge_on);
  EXPECT_EQ(inside.nearest_t, 3.0);
  EXPECT_TRUE(exact_ray_triangle(ray_of({2, 2, 3}, {0, 0, -1}), a, b, c, 0, kInfinity).on_edge);
  const ExactTriangleHit in_plane = exact_ray_triangle(ray_of({-2, 1, 0}, {1, 0, 0}), a, b, c, 0, kInfinity);
  EXPECT_TRUE(in_plane.hit && in_plane.edge_on);
  EXPECT_EQ(in_plane.t.down, 2.0f);
  EXPECT_FALSE(exact_ray_triangle(ray_of({-2, 5, 0}, {1, 0, 0}), a, b, c, 0, kInfinity).hit);
  EXPECT_TRUE(exact_ray_triangle(ray_of({1, 0, 5}, {0, 0, -1}), a, b, b, 0, kInfinity).hit) << "a segment";
  EXPECT_FALSE(exact_ray_triangle(ray_of({1, 1e-30f, 5}, {0, 0, -1}), a, b, b, 0, kInfinity).hit);
  EXPECT_TRUE(exact_ray_triangle(ray_of({9, 0, 0}, {-1, 0, 0}), a, b, b, 0, kInfinity).hit) << "along the segment";
  EXPECT_TRUE(exact_ray_triangle(ray_of({4, 0, 5}, {0, 0, -1}), b, b, b, 0, kInfinity).hit) << "a point";
}

TEST(ExactTriangle, a_hit_lies_within_the_span_of_the_triangles_box) {
  SCOPED_TRACE(seed_note());
  intersect::TriangleCases source(test_seed());
  int hits = 0;
  for (int i = 0; i < 5'000; ++i) {
    const intersect::TriangleCase c = source.next(source.power_of_ten(-20, 20));
    const ExactTriangleHit hit = exact_ray_triangle(c.ray, c.v[0], c.v[1], c.v[2], 0, kInfinity);
    if (!hit.hit) continue;
    Vec3 lo = c.v[0], hi = c.v[0];
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min({c.v[0][axis], c.v[1][axis], c.v[2][axis]});
      hi[axis] = std::max({c.v[0][axis], c.v[1][axis], c.v[2][axis]});
    }
    const ExactBoxSpan span = exact_box_span(c.ray, lo, hi, 0, kInfinity);
    ASSERT_TRUE(span.hit) << show(c);
    ASSERT_LE(span.entry.down, hit.t.down) << show(c);
    ASSERT_GE(span.exit.up, hit.t.up) << show(c);
    ++hits;
  }
  EXPECT_GT(hits, 500);
}

TEST(ExactRayCells, a_diagonal_touches_its_neighbours_corners_only_as_closed_cells) {
  const Ray ray = ray_of({-1, -1, -1}, {1, 1, 1});
  const auto closed = exact_ray_cells(ray, {0, 0, 0}, {1, 1, 1}, 4, 0, kInfinity, Cells::Closed);
  const auto half_open = exact_ray_cells(ray, {0, 0, 0}, {1, 1, 1}, 4, 0, kInfinity, Cells::HalfOpen);
  EXPECT_EQ(count(half_open), 4);
  EXPECT_EQ(count(closed), 4 + 3 * 6) << "at each inner corner eight cells meet, two of them on the diagonal";
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(half_open[cell(i, i, i, 4)]);
  const auto part = exact_ray_cells(ray, {0, 0, 0}, {1, 1, 1}, 4, 1.3f, 1.45f, Cells::Closed);
  EXPECT_EQ(count(part), 1);
  EXPECT_TRUE(part[cell(1, 1, 1, 4)]);
}

TEST(ExactRayCells, rays_in_cell_planes_and_on_the_last_face) {
  const Ray inner = ray_of({-1, 0.5f, 0.25f}, {1, 0, 0});
  EXPECT_EQ(count(exact_ray_cells(inner, {0, 0, 0}, {1, 1, 1}, 2, 0, kInfinity, Cells::Closed)), 4);
  const auto half_open = exact_ray_cells(inner, {0, 0, 0}, {1, 1, 1}, 2, 0, kInfinity, Cells::HalfOpen);
  EXPECT_EQ(count(half_open), 2);
  EXPECT_TRUE(half_open[cell(0, 1, 0, 2)]);
  const Ray last = ray_of({-1, 1, 1}, {1, 0, 0});
  EXPECT_EQ(count(exact_ray_cells(last, {0, 0, 0}, {1, 1, 1}, 2, 0, kInfinity, Cells::HalfOpen)), 2);
  EXPECT_EQ(count(exact_ray_cells(ray_of({-1, 2, 1}, {1, 0, 0}), {0, 0, 0}, {1, 1, 1}, 2, 0, kInfinity)), 0);
  const Ray through_flat = ray_of({0.1f, 0.1f, -1}, {0, 0, 1});
  EXPECT_EQ(count(exact_ray_cells(through_flat, {0, 0, 0}, {1, 1, 0}, 2, 0, kInfinity, Cells::Closed)), 2);
  EXPECT_EQ(count(exact_ray_cells(through_flat, {0, 0, 0}, {1, 1, 0}, 2, 0, kInfinity, Cells::HalfOpen)), 1);
}

TEST(ExactRayCells, half_open_cells_are_those_of_clamped_floors_of_points_on_the_ray) {
  SCOPED_TRACE(seed_note());
  std::mt19937_64 random(test_seed());
  constexpr int kResolution = 4;
  const auto lattice = [&] { return static_cast<float>(static_cast<int>(random() % 97) - 32) / 16.0f; };
  for (int i = 0; i < 2'000; ++i) {
    const Ray ray = ray_of({lattice(), lattice(), lattice()}, {lattice(), lattice(), lattice()});
    const auto half_open = exact_ray_cells(ray, {0, 0, 0}, {2, 2, 2}, kResolution, 0, 4, Cells::HalfOpen);
    const auto closed = exact_ray_cells(ray, {0, 0, 0}, {2, 2, 2}, kResolution, 0, 4, Cells::Closed);
    for (std::size_t c = 0; c < closed.size(); ++c) EXPECT_LE(half_open[c], closed[c]);
    for (int step = 0; step <= 4 * 32; ++step) {  // dyadic t: the point is exact in binary64
      int at[3];
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis) {
        const double x = ray.origin[axis] + step / 32.0 * ray.direction[axis];
        inside = inside && 0 <= x && x <= 2;
        at[axis] = std::clamp(static_cast<int>(x * 2), 0, kResolution - 1);
      }
      EXPECT_TRUE(!inside || half_open[cell(at[0], at[1], at[2], kResolution)]);
    }
  }
}

TEST(ExactTriangleCells, known_triangles) {
  const Vec3 lo{0, 0, 0}, hi{4, 4, 4};
  EXPECT_EQ(count(exact_triangle_cells(lo, hi, 4, {0.5f, 0.5f, 0.5f}, {0.6f, 0.5f, 0.5f}, {0.5f, 0.6f, 0.5f})), 1);
  EXPECT_EQ(count(exact_triangle_cells(lo, hi, 4, {1, 1, 1}, {1, 1, 1}, {1, 1, 1})), 8) << "a point on a cell corner";
  EXPECT_EQ(count(exact_triangle_cells(lo, hi, 4, {-1, -1, 2}, {9, -1, 2}, {-1, 9, 2})), 2 * 16) << "a cell plane";
  EXPECT_EQ(count(exact_triangle_cells(lo, hi, 4, {0.5f, 0.5f, 0.5f}, {3.5f, 0.5f, 0.5f}, {2, 0.5f, 0.5f})), 4);
  EXPECT_EQ(count(exact_triangle_cells(lo, hi, 4, {5, 0, 0}, {5, 4, 0}, {5, 0, 4})), 0);
  // x + y + z = 3 cuts or touches the cells with 0 <= x + y + z <= 3 at their lower corners.
  EXPECT_EQ(count(exact_triangle_cells(lo, hi, 4, {3, 0, 0}, {0, 3, 0}, {0, 0, 3})), 1 + 3 + 6 + 10);
}

TEST(ExactTriangleCells, points_of_a_triangle_lie_in_touched_cells) {
  SCOPED_TRACE(seed_note());
  std::mt19937_64 random(test_seed());
  constexpr int kResolution = 4;
  const auto lattice = [&] { return static_cast<float>(static_cast<int>(random() % 65) - 16) / 8.0f; };
  for (int i = 0; i < 500; ++i) {
    Vec3 v[3];
    for (Vec3& vertex : v) vertex = {lattice(), lattice(), lattice()};
    const auto touched = exact_triangle_cells({0, 0, 0}, {4, 4, 4}, kResolution, v[0], v[1], v[2]);
    for (int a = 0; a <= 16; ++a) {
      for (int b = 0; a + b <= 16; ++b) {
        int at[3];
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
          const float x = ((16 - a - b) * v[0][axis] + a * v[1][axis] + b * v[2][axis]) / 16;  // exact
          inside = inside && 0 <= x && x <= 4;
          at[axis] = std::clamp(static_cast<int>(x), 0, kResolution - 1);
        }
        EXPECT_TRUE(!inside || touched[cell(at[0], at[1], at[2], kResolution)]);
      }
    }
  }
}

// A segment as a triangle without area touches the closed cells that a ray along it touches.
TEST(ExactTriangleCells, a_collapsed_triangle_touches_the_cells_of_its_segment) {
  SCOPED_TRACE(seed_note());
  std::mt19937_64 random(test_seed());
  const auto lattice = [&] { return static_cast<float>(static_cast<int>(random() % 49) - 8) / 8.0f; };
  for (int i = 0; i < 500; ++i) {
    const Vec3 p{lattice(), lattice(), lattice()}, q{lattice(), lattice(), lattice()};
    const Vec3 along{q.x - p.x, q.y - p.y, q.z - p.z};
    EXPECT_EQ(exact_triangle_cells({0, 0, 0}, {3, 4, 0}, 3, p, q, p),
              exact_ray_cells(ray_of(p, along), {0, 0, 0}, {3, 4, 0}, 3, 0, 1, Cells::Closed))
        << i;
    EXPECT_EQ(exact_triangle_cells({0, 0, 0}, {3, 4, 5}, 3, p, q, p),
              exact_ray_cells(ray_of(p, along), {0, 0, 0}, {3, 4, 5}, 3, 0, 1, Cells::Closed))
        << i;
  }
}

}  // namespace
}  // namespace ctu::oracle
