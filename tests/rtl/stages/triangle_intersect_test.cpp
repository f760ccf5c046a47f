// rtl/triangle_intersect.sv against intersect::triangle_test on hostile triangles: every bit of every outcome, one a
// cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>

#include "VMutantEdgeOnHit.h"
#include "VMutantEdgeSignOfZero.h"
#include "VMutantTriangleRangeOpen.h"
#include "VTriangleIntersect.h"
#include "model/intersect/triangle_test.h"
#include "tests/intersect/triangle_cases.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using intersect::PreparedRay;
using intersect::TriangleCase;
using intersect::TriangleResult;
using numeric::bits;

/// Triangles of every size of binary32 with rays at their corners, edges, inside and beside; a third of them on a
/// coarse grid, where edge functions are zero, triangles are seen edge-on or are lines and points, and rays run along
/// axes.
class HostileTriangles {
 public:
  explicit HostileTriangles(std::uint64_t seed) : cases_(seed) {}

  TriangleCase next() {
    static constexpr double kSizes[][2] = {{-3, 3}, {-28, -10}, {-44, -36}, {30, 34}, {36, 38.2}};
    const auto& range = kSizes[static_cast<int>(cases_.uniform(0, 5))];
    const double size = cases_.power_of_ten(range[0], range[1]);
    TriangleCase c = cases_.next(size);
    if (cases_.chance(0.33)) move_to_grid(c, size);
    if (cases_.chance(0.1)) c.v[1] = c.ray.origin;
    if (cases_.chance(0.03)) c.v[2] = c.v[1] = c.v[0];
    if (cases_.chance(0.05)) c.ray.direction[axis()] = -0.0f;
    if (cases_.chance(0.05)) c.ray.direction[axis()] *= 1e-30f;
    if (cases_.chance(0.1)) scale(c.ray.direction, cases_.power_of_ten(-44, 0));
    if (cases_.chance(0.2)) scale(c.ray.direction, cases_.power_of_ten(34, 38) / size);  // t is small, or subnormal
    for (Vec3* v : {&c.ray.origin, &c.ray.direction, &c.v[0], &c.v[1], &c.v[2]})
      for (int a = 0; a < 3; ++a) (*v)[a] = finite((*v)[a]);
    choose_range(c);
    return c;
  }

 private:
  int axis() { return static_cast<int>(cases_.uniform(0, 3)); }
  static float finite(float x) { return std::isfinite(x) ? x : std::copysign(0x1.fffffep127f, x); }
  static void scale(Vec3& v, double by) {
    for (int a = 0; a < 3; ++a) v[a] = static_cast<float>(v[a] * by);
  }
  void move_to_grid(TriangleCase& c, double size) {
    const double step = size * 0.25;
    const auto move = [&](Vec3& v) {
      for (int a = 0; a < 3; ++a) v[a] = static_cast<float>(std::round(v[a] / step) * step);
    };
    for (Vec3& v : c.v) move(v);
    move(c.ray.origin);
    move(c.ray.direction);
    if (cases_.chance(0.4)) c.ray.direction[axis()] = 0;
    if (cases_.chance(0.2)) c.ray.origin = c.v[axis()];
  }
  /// Ends of the interval at the hit itself, one place beside it, and anywhere, also behind the origin.
  void choose_range(TriangleCase& c) {
    c.ray.tmin = -0x1.fffffep127f;
    c.ray.tmax = std::numeric_limits<float>::infinity();
    const PreparedRay ray = intersect::prepare_ray(c.ray);
    if (!ray.valid) return;
    const float t = intersect::triangle_test(ray, c.v[0], c.v[1], c.v[2], c.ray.tmax).t;
    const float ends[] = {t, numeric::next_up(t), numeric::next_down(t), -0.0f,
                          static_cast<float>(cases_.uniform(-2, 2))};
    if (cases_.chance(0.5)) c.ray.tmin = std::isfinite(t) ? ends[static_cast<int>(cases_.uniform(0, 5))] : 0;
    if (cases_.chance(0.5)) c.ray.tmax = ends[static_cast<int>(cases_.uniform(0, 5))];
    if (!(c.ray.tmin <= c.ray.tmax)) std::swap(c.ray.tmin, c.ray.tmax);
    if (!std::isfinite(c.ray.tmin)) c.ray.tmin = 0;
  }

  intersect::TriangleCases cases_;
};

template <class Model>
void set_inputs(Model& twin, const PreparedRay& ray, const TriangleCase& c) {
  BitWriter vertices(&twin.vertices_i[0]), origin(&twin.origin_i[0]);
  for (const Vec3& v : c.v)
    for (int axis = 0; axis < 3; ++axis) vertices.put(v[axis]);
  for (int axis = 0; axis < 3; ++axis) origin.put(ray.ray.origin[axis]);
  twin.direction_z_i = bits(ray.ray.direction[ray.kz]);
  twin.kx_i = ray.kx;
  twin.ky_i = ray.ky;
  twin.kz_i = ray.kz;
  twin.sx_i = bits(ray.sx);
  twin.sy_i = bits(ray.sy);
  twin.tmin_i = bits(ray.ray.tmin);
  twin.tmax_i = bits(ray.ray.tmax);
}

struct Compared {
  std::string difference;
  int triangles = 0, hits = 0, subnormal = 0, infinite = 0;
};

/// `count` hostile triangles through a twin of latency 1. Stops at the first difference.
template <class Model>
Compared compare(int count) {
  VerilatedContext context;
  Model twin(&context);
  twin.enable_i = 1;
  HostileTriangles hostile(oracle::test_seed());
  Difference difference;
  Compared compared;
  for (int i = 0; i < count && compared.difference.empty(); ++i) {
    const TriangleCase c = hostile.next();
    const PreparedRay ray = intersect::prepare_ray(c.ray);
    if (!ray.valid) continue;
    const TriangleResult should = intersect::triangle_test(ray, c.v[0], c.v[1], c.v[2], c.ray.tmax);
    set_inputs(twin, ray, c);
    twin.eval();
    clock(twin);
    difference.same("hit", twin.hit_o, should.hit)
        .same("t", twin.t_o, bits(should.t))
        .same("u", twin.u_o, bits(should.u))
        .same("v", twin.v_o, bits(should.v));
    const std::string found = difference.take();
    if (!found.empty()) compared.difference = "triangle " + std::to_string(i) + ", " + found + intersect::show(c);
    ++compared.triangles;
    compared.hits += should.hit;
    compared.subnormal += should.hit && std::fpclassify(should.t) == FP_SUBNORMAL;
    compared.infinite += should.hit && std::isinf(should.t);
  }
  return compared;
}

TEST(TriangleIntersect, gives_the_bits_of_the_triangle_test_on_hostile_triangles) {
  SCOPED_TRACE(oracle::seed_note());
  const Compared compared = compare<VTriangleIntersect>(std::getenv("CTU_LONG_TESTS") ? 3'000'000 : 200'000);
  EXPECT_EQ(compared.difference, "");
  EXPECT_GT(compared.hits, compared.triangles / 10);
  EXPECT_LT(compared.hits, compared.triangles / 2);
  EXPECT_GT(compared.subnormal, compared.triangles / 1000);
  EXPECT_GT(compared.infinite, compared.triangles / 1000);
}

template <class Model>
void expect_caught() {
  SCOPED_TRACE(oracle::seed_note());
  const Compared compared = compare<Model>(50'000);
  EXPECT_NE(compared.difference, "");
  std::cout << compared.difference << '\n';
}
TEST(TriangleIntersectMutants, an_edge_function_of_zero_taken_for_a_positive_one_is_caught) {
  expect_caught<VMutantEdgeSignOfZero>();
}
TEST(TriangleIntersectMutants, a_triangle_seen_edge_on_and_hit_is_caught) { expect_caught<VMutantEdgeOnHit>(); }
TEST(TriangleIntersectMutants, an_end_of_the_interval_that_does_not_belong_to_it_is_caught) {
  expect_caught<VMutantTriangleRangeOpen>();
}

}  // namespace
}  // namespace ctu::rtl
