// rtl/sphere_intersect.sv against intersect::sphere_test on hostile spheres: every bit of every outcome, one a cycle.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "VMutantSphereGrazedMisses.h"
#include "VMutantSphereNoFarEnd.h"
#include "VSphereIntersect.h"
#include "model/intersect/sphere_test.h"
#include "tests/intersect/sphere_cases.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using intersect::PreparedRay;
using intersect::SphereCase;
using intersect::SphereResult;
using numeric::bits;

/// Spheres of every size of binary32, at their silhouettes, from inside, points, and with intervals that end at the
/// hit; a third of them on a coarse grid, where rays touch at one point exactly, run along axes and begin on the
/// surface.
class HostileSpheres {
 public:
  explicit HostileSpheres(std::uint64_t seed) : cases_(seed) {}

  SphereCase next() {
    static constexpr double kSizes[][2] = {{-3, 3}, {-28, -10}, {-44, -36}, {30, 34}, {36, 37.5}};
    const auto& range = kSizes[static_cast<int>(cases_.uniform(0, 5))];
    const double size = cases_.power_of_ten(range[0], range[1]);
    SphereCase c = cases_.next(size);
    if (cases_.chance(0.33)) move_to_grid(c, size);
    if (cases_.chance(0.05)) c.ray.direction[axis()] = -0.0f;
    if (cases_.chance(0.05)) c.ray.direction[axis()] *= 1e-30f;
    if (cases_.chance(0.1)) scale(c.ray.direction, cases_.power_of_ten(-44, 0));
    if (cases_.chance(0.2)) scale(c.ray.direction, cases_.power_of_ten(34, 38) / size);  // t is small, or subnormal
    for (Vec3* v : {&c.ray.origin, &c.ray.direction, &c.sphere.centre})
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
  void move_to_grid(SphereCase& c, double size) {
    const double step = size * 0.25;
    const auto move = [&](float& x) { x = static_cast<float>(std::round(x / step) * step); };
    for (Vec3* v : {&c.ray.origin, &c.ray.direction, &c.sphere.centre})
      for (int a = 0; a < 3; ++a) move((*v)[a]);
    move(c.sphere.radius);
    if (cases_.chance(0.4)) c.ray.direction[axis()] = 0;
    if (cases_.chance(0.2)) {
      c.ray.origin = c.sphere.centre;
      c.ray.origin[axis()] += c.sphere.radius;
    }
  }
  /// Ends of the interval at the hit itself, one place beside it, and anywhere, also behind the origin.
  void choose_range(SphereCase& c) {
    c.ray.tmin = -0x1.fffffep127f;
    c.ray.tmax = std::numeric_limits<float>::infinity();
    const PreparedRay ray = intersect::prepare_ray(c.ray);
    if (!ray.valid) return;
    const float t = intersect::sphere_test(ray, c.sphere, c.ray.tmax).t;
    const float ends[] = {t, numeric::next_up(t), numeric::next_down(t), -0.0f,
                          static_cast<float>(cases_.uniform(-2, 2))};
    if (cases_.chance(0.5)) c.ray.tmin = std::isfinite(t) ? ends[static_cast<int>(cases_.uniform(0, 5))] : 0;
    if (cases_.chance(0.5)) c.ray.tmax = ends[static_cast<int>(cases_.uniform(0, 5))];
    if (!(c.ray.tmin <= c.ray.tmax)) std::swap(c.ray.tmin, c.ray.tmax);
    if (!std::isfinite(c.ray.tmin)) c.ray.tmin = 0;
  }

  intersect::SphereCases cases_;
};

template <class Model>
void set_inputs(Model& twin, const SphereCase& c) {
  BitWriter origin(&twin.origin_i[0]), direction(&twin.direction_i[0]), centre(&twin.centre_i[0]);
  for (int axis = 0; axis < 3; ++axis) {
    origin.put(c.ray.origin[axis]);
    direction.put(c.ray.direction[axis]);
    centre.put(c.sphere.centre[axis]);
  }
  twin.radius_i = bits(c.sphere.radius);
  twin.tmin_i = bits(c.ray.tmin);
  twin.tmax_i = bits(c.ray.tmax);
}

struct Compared {
  std::string difference;
  int spheres = 0, hits = 0, subnormal = 0, far_ends = 0;
};

/// `count` hostile spheres through a twin of latency 1. Stops at the first difference.
template <class Model>
Compared compare(int count) {
  VerilatedContext context;
  Model twin(&context);
  twin.enable_i = 1;
  HostileSpheres hostile(oracle::test_seed());
  Difference difference;
  Compared compared;
  for (int i = 0; i < count && compared.difference.empty(); ++i) {
    const SphereCase c = hostile.next();
    const PreparedRay ray = intersect::prepare_ray(c.ray);
    if (!ray.valid) continue;
    const SphereResult should = intersect::sphere_test(ray, c.sphere, c.ray.tmax);
    set_inputs(twin, c);
    twin.eval();
    clock(twin);
    difference.same("hit", twin.hit_o, should.hit).same("t", twin.t_o, bits(should.t));
    const std::string found = difference.take();
    if (!found.empty()) compared.difference = "sphere " + std::to_string(i) + ", " + found + intersect::show(c);
    ++compared.spheres;
    compared.hits += should.hit;
    compared.subnormal += should.hit && std::fpclassify(should.t) == FP_SUBNORMAL;
    PreparedRay whole = ray;
    whole.ray.tmin = -0x1.fffffep127f;
    compared.far_ends += should.hit && bits(intersect::sphere_test(whole, c.sphere, c.ray.tmax).t) != bits(should.t);
  }
  return compared;
}

TEST(SphereIntersect, gives_the_bits_of_the_sphere_test_on_hostile_spheres) {
  SCOPED_TRACE(oracle::seed_note());
  const Compared compared = compare<VSphereIntersect>(std::getenv("CTU_LONG_TESTS") ? 3'000'000 : 200'000);
  EXPECT_EQ(compared.difference, "");
  EXPECT_GT(compared.hits, compared.spheres / 5);
  EXPECT_LT(compared.hits, compared.spheres * 9 / 10);
  EXPECT_GT(compared.subnormal, compared.spheres / 1000);
  EXPECT_GT(compared.far_ends, compared.spheres / 100);
}

template <class Model>
void expect_caught() {
  SCOPED_TRACE(oracle::seed_note());
  const Compared compared = compare<Model>(50'000);
  EXPECT_NE(compared.difference, "");
  std::cout << compared.difference << '\n';
}
TEST(SphereIntersectMutants, a_sphere_that_is_only_touched_and_missed_is_caught) {
  expect_caught<VMutantSphereGrazedMisses>();
}
TEST(SphereIntersectMutants, a_chord_without_its_far_end_is_caught) { expect_caught<VMutantSphereNoFarEnd>(); }

}  // namespace
}  // namespace ctu::rtl
