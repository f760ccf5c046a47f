// The fast tracer against its definition: every triangle tested by triangle_test, the best kept by replaces(). The
// hits must be equal to the bit, rays that only rounding makes hit included.
#include "model/reference/closest_hit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "model/accel/build.h"
#include "model/intersect/triangle_test.h"
#include "model/numeric/round.h"
#include "model/scene/load.h"
#include "tests/oracle/seed.h"
#include "tests/reference/brute_force.h"

namespace {

using namespace ctu;
using intersect::Hit;
using intersect::Ray;
using test::brute_force;

constexpr float kForever = std::numeric_limits<float>::infinity();

std::string describe(const Ray& ray) {
  std::string text = "ray bits";
  for (const float f : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z,
                        ray.tmin, ray.tmax})
    text += " " + std::to_string(numeric::bits(f));
  return text;
}

class World {
 public:
  explicit World(scene::Mesh mesh) : mesh_(std::move(mesh)), bvh_(accel::build(mesh_, {})), tracer_(bvh_) {}

  /// Checks closest() and occluded() of one ray; true when it hit.
  bool check(const Ray& ray) const {
    const Hit expected = brute_force(mesh_, ray), found = tracer_.closest(ray);
    EXPECT_TRUE(intersect::same_bits(expected, found))
        << describe(ray) << "\nexpected t " << expected.t << " primitive " << expected.primitive << ", found t "
        << found.t << " primitive " << found.primitive;
    const bool hit = expected.primitive != intersect::kNoPrimitive;
    EXPECT_EQ(hit, tracer_.occluded(ray)) << describe(ray);
    return hit;
  }

  const scene::Mesh& mesh() const { return mesh_; }
  const accel::Bvh4& bvh() const { return bvh_; }
  Vec3 vertex(std::size_t i) const { return mesh_.vertices[i % mesh_.vertices.size()]; }

 private:
  scene::Mesh mesh_;
  accel::Bvh4 bvh_;
  reference::FastTracer tracer_;
};

World& quads() {
  static World world(scene::load("gen:tilted-quads?quads=700").mesh);
  return world;
}
World& tetra() {  // vertices on a lattice: many exact zeros, shared edges, equal t
  static World world(scene::load("gen:tetra?depth=5").mesh);
  return world;
}
World& hair() {
  static World world(scene::load("gen:hair-ball?strands=60&thickness=0.02").mesh);
  return world;
}

scene::Mesh transformed(scene::Mesh mesh, float scale, float offset) {
  for (Vec3& v : mesh.vertices) v = {v.x * scale + offset, v.y * scale - offset, v.z * scale + 2 * offset};
  return mesh;
}

struct Dice {
  std::mt19937_64 engine{oracle::test_seed()};
  std::uint64_t below(std::uint64_t n) { return engine() % n; }
  float between(float a, float b) { return a + (b - a) * (static_cast<float>(engine() >> 40) * 0x1p-24f); }
  Vec3 point(float r) { return {between(-r, r), between(-r, r), between(-r, r)}; }
};

Vec3 minus(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 middle(const Vec3& a, const Vec3& b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2}; }

void check_all(const World& world, int rays, const std::function<Ray(Dice&)>& make) {
  SCOPED_TRACE(oracle::seed_note());
  Dice dice;
  int hits = 0;
  for (int i = 0; i < rays && !testing::Test::HasFailure(); ++i) hits += world.check(make(dice));
  EXPECT_GT(hits, rays / 200) << "the family must exercise hits";
}

void check_aimed(const World& world, int rays, float distance) {
  check_all(world, rays, [&](Dice& dice) {
    const auto& c = world.mesh().triangles[dice.below(world.mesh().triangles.size())];
    const Vec3 from = dice.point(distance);
    const Vec3 at = dice.below(2) == 0 ? world.vertex(c[0]) : middle(world.vertex(c[0]), world.vertex(c[1]));
    return Ray{from, 0, minus(at, from), kForever};
  });
}

TEST(FastTracer, equals_brute_force_on_random_lines) {
  for (const World* world : {&quads(), &tetra(), &hair()})
    check_all(*world, 2000, [](Dice& dice) {
      const Vec3 from = dice.point(2);
      return Ray{from, 0, minus(dice.point(1), from), kForever};
    });
}

TEST(FastTracer, equals_brute_force_on_rays_aimed_at_vertices_and_edges) {
  for (const World* world : {&quads(), &tetra(), &hair()}) check_aimed(*world, 2000, 3);
}

TEST(FastTracer, equals_brute_force_from_far_origins) {
  for (const float distance : {1e3f, 1e5f, 1e7f})
    for (const World* world : {&quads(), &hair()}) check_aimed(*world, 500, distance);
}

TEST(FastTracer, equals_brute_force_on_rays_along_the_axes) {
  for (const World* world : {&quads(), &tetra()})
    check_all(*world, 1500, [&](Dice& dice) {
      Vec3 direction{0, dice.below(2) == 0 ? 0.0f : -0.0f, -0.0f};
      std::swap(direction.y, direction[static_cast<int>(dice.below(3))]);
      const int axis = static_cast<int>(dice.below(3));
      direction[axis] = dice.below(2) == 0 ? 1.0f : -1.0f;
      Vec3 origin = world->vertex(dice.below(world->mesh().vertices.size()));
      origin[axis] -= 4 * direction[axis];
      return Ray{origin, 0, direction, kForever};
    });
}

TEST(FastTracer, equals_brute_force_on_directions_with_tiny_components) {
  for (const float tiny : {1e-8f, 1e-17f, 1e-19f, 1e-30f, 1e-42f})
    check_all(quads(), 400, [&](Dice& dice) {
      const int axis = static_cast<int>(dice.below(3));
      Vec3 direction = dice.point(tiny);
      direction[axis] = dice.below(2) == 0 ? 1.0f : -1.0f;
      Vec3 origin = quads().vertex(dice.below(quads().mesh().vertices.size()));
      origin[axis] -= 2 * direction[axis];
      return Ray{origin, 0, direction, kForever};
    });
}

TEST(FastTracer, equals_brute_force_from_the_surface_and_with_short_rays) {
  for (const World* world : {&quads(), &tetra()})
    check_all(*world, 2000, [&](Dice& dice) {
      const Vec3 from = world->vertex(dice.below(world->mesh().vertices.size()));
      const float tmin = dice.below(2) == 0 ? 0.0f : dice.between(-1, 1);
      return Ray{from, tmin, dice.point(1), tmin + dice.between(0, 2)};
    });
}

TEST(FastTracer, equals_brute_force_when_tmax_or_tmin_is_the_hit) {
  Dice dice;
  SCOPED_TRACE(oracle::seed_note());
  for (int i = 0; i < 500; ++i) {
    const Vec3 from = dice.point(2);
    Ray ray{from, 0, minus(dice.point(0.5f), from), kForever};
    const Hit hit = brute_force(quads().mesh(), ray);
    if (hit.primitive == intersect::kNoPrimitive) continue;
    ray.tmax = hit.t;
    EXPECT_TRUE(quads().check(ray));
    ray.tmax = numeric::next_down(hit.t);
    EXPECT_FALSE(quads().check(ray));
    ray.tmin = hit.t;
    ray.tmax = kForever;
    EXPECT_TRUE(quads().check(ray));
  }
}

TEST(FastTracer, equals_brute_force_at_every_scale_and_length_of_direction) {
  const scene::Mesh mesh = scene::load("gen:tilted-quads?quads=60").mesh;
  for (const float scale : {1e-38f, 1e-30f, 1e-12f, 1e-4f, 1e4f, 1e12f, 1e30f}) {
    const World world(transformed(mesh, scale, 0));
    for (const float length : {1e-30f, 1e-10f, 1.0f, 1e10f, 1e30f})
      check_all(world, 100, [&](Dice& dice) {
        const auto& c = world.mesh().triangles[dice.below(world.mesh().triangles.size())];
        const Vec3 from = dice.point(2 * scale), to = middle(world.vertex(c[0]), world.vertex(c[1]));
        Vec3 d = minus(to, from);
        for (int axis = 0; axis < 3; ++axis) d[axis] = d[axis] / scale * length;
        return Ray{from, 0, d, kForever};
      });
  }
}

TEST(FastTracer, equals_brute_force_on_a_mesh_far_from_the_origin) {
  const World world(transformed(scene::load("gen:tilted-quads?quads=300").mesh, 1, 3000));
  check_all(world, 1500, [&](Dice& dice) {
    const Vec3 at = world.vertex(dice.below(world.mesh().vertices.size()));
    const Vec3 step = dice.point(3);
    return Ray{{at.x + step.x, at.y + step.y, at.z + step.z}, 0, {-step.x, -step.y, -step.z}, kForever};
  });
}

TEST(FastTracer, answers_a_ray_that_is_not_valid_with_a_miss) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Ray& ray : {Ray{{0, 0, 0}, 0, {0, 0, 0}, 1}, Ray{{nan, 0, 0}, 0, {1, 0, 0}, 1},
                         Ray{{0, 0, 0}, 0, {1, kForever, 0}, 1}, Ray{{0, 0, 0}, 2, {1, 0, 0}, 1}}) {
    EXPECT_EQ(quads().check(ray), false);
  }
}

TEST(FastTracer, keeps_the_lowest_primitive_of_identical_triangles) {
  scene::Mesh mesh;
  mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles.assign(500, {0, 1, 2});
  const World world(std::move(mesh));
  const Ray ray{{0.1f, 0, -3}, 0, {0, 0, 1}, kForever};
  EXPECT_TRUE(world.check(ray));
  EXPECT_EQ(reference::FastTracer(world.bvh()).closest(ray).primitive, 0u);
}

}  // namespace
