// Scenes with spheres in the reference: against every primitive tested by itself, and against the exact oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "model/accel/build.h"
#include "model/accel/leaf_record.h"
#include "model/cull/object_masks.h"
#include "model/intersect/sphere_test.h"
#include "model/intersect/triangle_test.h"
#include "model/numeric/round.h"
#include "model/reference/closest_hit.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/oracle/ray_oracle.h"
#include "tests/oracle/seed.h"
#include "tests/reference/brute_force.h"

namespace {

using namespace ctu;
using intersect::Hit;
using intersect::Ray;
using test::brute_force;

constexpr float kForever = std::numeric_limits<float>::infinity();

bool exactly_met(const scene::Mesh& mesh, const Ray& ray, std::uint32_t id) {
  oracle::RayOracle exact(ray);
  const accel::LeafTriangle p = accel::leaf_record(mesh, id);
  return p.is_sphere() ? exact.meets_sphere(p.v0, p.v1.x) : exact.meets_triangle(p.v0, p.v1, p.v2);
}

std::string describe(const Ray& ray) {
  std::ostringstream text;
  text << "ray bits" << std::hex;
  for (const float f : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z,
                        ray.tmin, ray.tmax})
    text << " 0x" << numeric::bits(f);
  return text.str();
}

class Dice {
 public:
  double between(double low, double high) { return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t n) { return bits_() % n; }
  Vec3 point(double r) {
    const auto number = [&] { return static_cast<float>(between(-r, r)); };
    return {number(), number(), number()};
  }

 private:
  std::mt19937_64 bits_{oracle::test_seed()};
};

/// From somewhere, at times a surface, toward a sphere; one in three just past its silhouette.
Ray aimed(Dice& dice, const scene::Mesh& mesh, double reach) {
  const auto& spheres = mesh.spheres;
  const scene::Sphere& target = spheres[dice.below(spheres.size())];
  Ray ray{dice.point(reach), 0, {}, kForever};
  if (dice.below(3) == 0) {
    const scene::Sphere& from = spheres[dice.below(spheres.size())];
    ray.origin = from.centre;
    ray.origin.z += from.radius;
  }
  double along[3], out[3], across = 0, square = 0, length = 0;
  for (int a = 0; a < 3; ++a) {
    along[a] = double{target.centre[a]} - ray.origin[a];
    out[a] = dice.between(-1, 1);
    across += out[a] * along[a];
    square += along[a] * along[a];
  }
  if (square == 0) square = along[0] = 1;
  for (int a = 0; a < 3; ++a) {
    out[a] -= across / square * along[a];
    length += out[a] * out[a];
  }
  const double r = target.radius;
  const double far = dice.below(3) == 0 ? r * (1 + dice.between(-1, 1) * 1e-6) : r * dice.between(0, 1.5);
  for (int a = 0; a < 3; ++a) ray.direction[a] = static_cast<float>(along[a] + out[a] / std::sqrt(length) * far);
  if (dice.below(4) == 0) ray.tmax = static_cast<float>(dice.between(0.5, 1.5));
  return ray;
}

scene::Mesh scaled(scene::Mesh mesh, float scale, float offset) {
  const auto moved = [&](const Vec3& v) { return Vec3{v.x * scale + offset, v.y * scale - offset, v.z * scale}; };
  for (Vec3& v : mesh.vertices) v = moved(v);
  for (scene::Sphere& s : mesh.spheres) s = {moved(s.centre), s.radius * scale};
  return mesh;
}

struct World {
  scene::Mesh mesh;
  double reach;
};

std::vector<World> worlds() {
  const scene::Mesh balls = scene::load("gen:balls?depth=2").mesh;
  return {{balls, 3}, {scaled(balls, 1e-3f, 1), 2}, {scaled(balls, 1e4f, 0), 1e5}, {scaled(balls, 1, 1000), 2000}};
}

TEST(SpheresInTheReference, the_fast_tracer_equals_every_primitive_tested_by_itself) {
  SCOPED_TRACE(oracle::seed_note());
  for (const World& world : worlds()) {
    const accel::Bvh4 bvh = accel::build(world.mesh, {});
    const reference::FastTracer tracer(bvh);
    Dice dice;
    int hits = 0;
    for (int i = 0; i < 10'000; ++i) {
      const Ray ray = aimed(dice, world.mesh, world.reach);
      const Hit should = brute_force(world.mesh, ray), is = tracer.closest(ray);
      ASSERT_TRUE(intersect::same_bits(is, should)) << describe(ray);
      ASSERT_EQ(tracer.occluded(ray), should.primitive != intersect::kNoPrimitive) << describe(ray);
      hits += should.primitive != intersect::kNoPrimitive;
    }
    EXPECT_GT(hits, 3000);
  }
}

TEST(SpheresInTheReference, the_traversal_loses_nothing_that_the_exact_ray_meets_with_culling_and_without) {
  SCOPED_TRACE(oracle::seed_note());
  const cull::MaskOptions options{.resolution = 4, .ray_resolution = 4};
  for (const World& world : worlds()) {
    const accel::Bvh4 bvh = accel::build(world.mesh, {});
    const cull::ObjectMasks masks = cull::build_object_masks(bvh, options, 1);
    int missed = 0, culled_visits = 0;
    for (const cull::Design design : {cull::Design::None, cull::Design::MaskLut, cull::Design::Comparators}) {
      const cull::MaskTester tester(design, options);
      const reference::Traversal traversal(bvh, design == cull::Design::None ? nullptr : &masks, tester);
      Dice dice;
      for (int i = 0; i < 5'000; ++i) {
        Ray ray = aimed(dice, world.mesh, world.reach);
        if (i % 4 == 0) ray.kind = intersect::RayKind::AnyHit;
        const Hit should = brute_force(world.mesh, ray);
        reference::StepList steps;
        const Hit is = traversal.trace(ray, &steps);
        culled_visits += static_cast<int>(reference::count_steps(steps, 0, 1).culled);
        if (ray.kind == intersect::RayKind::AnyHit) {
          if (is.primitive == intersect::kNoPrimitive && should.primitive != intersect::kNoPrimitive) ++missed;
          if (is.primitive != intersect::kNoPrimitive || should.primitive == intersect::kNoPrimitive) continue;
        } else if (intersect::same_bits(is, should)) {
          continue;
        }
        // Only what rounding alone accepts may be another answer.
        ASSERT_FALSE(exactly_met(world.mesh, ray, should.primitive)) << describe(ray);
      }
    }
    EXPECT_LT(missed, 20);
    EXPECT_GT(culled_visits, 100);
  }
}

TEST(SpheresInTheReference, a_sphere_answers_with_its_id_behind_the_triangles_and_no_coordinates) {
  scene::Mesh mesh;
  mesh.vertices = {{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}};
  mesh.triangles = {{0, 1, 2}};
  mesh.spheres = {{{0, 0, 3}, 1}, {{0, 0, 8}, 1}};
  const accel::Bvh4 bvh = accel::build(mesh, {});
  const cull::MaskTester none(cull::Design::None, {});
  const reference::Traversal traversal(bvh, nullptr, none);
  const auto along_z = [](float from) { return Ray{{0, 0, from}, 0, {0, 0, 1}, kForever}; };
  EXPECT_EQ(traversal.trace(along_z(0)), (Hit{2, 0, 0, 1}));
  EXPECT_EQ(traversal.trace(along_z(4.5f)).primitive, 0u);
  EXPECT_EQ(traversal.trace(along_z(6)), (Hit{1, 0, 0, 2}));
  EXPECT_EQ(reference::FastTracer(bvh).closest(along_z(8)), (Hit{1, 0, 0, 2}));  // from inside
}

}  // namespace
