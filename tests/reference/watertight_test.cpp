// Rays aimed at the vertices and edges of closed meshes, through the tree, with every mask-test design: none may leak.
// Ordinary random rays never see such holes (the best libraries lose 2 to 49 % of the rays aimed at vertices).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "model/accel/build.h"
#include "model/reference/closest_hit.h"
#include "model/reference/traversal.h"
#include "tests/oracle/seed.h"
#include "tests/support/closed_meshes.h"

namespace {

using namespace ctu;
using cull::Design;
using intersect::Ray;

struct Aim {
  Vec3 target;    ///< a vertex or a point of an edge
  bool outward;   ///< from the middle of the mesh, where every direction must hit
};

/// Every vertex once, and a random point of every edge, rounded to binary32.
std::vector<Vec3> aimed_points(const scene::Mesh& mesh, std::mt19937_64& random) {
  std::vector<Vec3> points = mesh.vertices;
  for (const auto& t : mesh.triangles)
    for (int e = 0; e < 3; ++e) {
      if (t[e] > t[(e + 1) % 3]) continue;  // once for the two triangles at the edge
      const float s = std::uniform_real_distribution<float>(0, 1)(random);
      const Vec3 p = mesh.vertices[t[e]], q = mesh.vertices[t[(e + 1) % 3]];
      points.push_back({p.x + s * (q.x - p.x), p.y + s * (q.y - p.y), p.z + s * (q.z - p.z)});
    }
  return points;
}

/// From inside, a ray leaves a closed mesh whatever its direction: every miss is a leak. The middle is moved a little so that
/// rays are not symmetric.
Ray from_inside(const Vec3& middle, const Vec3& target, std::mt19937_64& random) {
  const auto jitter = [&] { return std::uniform_real_distribution<float>(-0.3f, 0.3f)(random); };
  const Vec3 origin{middle.x + jitter(), middle.y + jitter(), middle.z + jitter()};
  return {origin, 0, {target.x - origin.x, target.y - origin.y, target.z - origin.z}, std::numeric_limits<float>::infinity(),
          intersect::RayKind::ClosestHit};
}

/// From far outside towards a point on the near side: the ray passes through the body, whatever edge it meets first, as the
/// point does not lie on the silhouette.
Ray from_outside(const Vec3& middle, const Vec3& target, float distance, std::mt19937_64& random) {
  const auto jitter = [&] { return std::uniform_real_distribution<float>(-0.2f, 0.2f)(random); };
  const Vec3 out{target.x - middle.x + jitter(), target.y - middle.y + jitter(), target.z - middle.z + jitter()};
  const Vec3 origin{target.x + distance * out.x, target.y + distance * out.y, target.z + distance * out.z};
  return {origin, 0, {target.x - origin.x, target.y - origin.y, target.z - origin.z}, std::numeric_limits<float>::infinity(),
          intersect::RayKind::ClosestHit};
}

void expect_no_leak(const std::string& name, const scene::Mesh& mesh, const Vec3& middle) {
  std::mt19937_64 random(oracle::test_seed());
  const accel::Bvh4 bvh = accel::build(mesh, {});
  const cull::ObjectMasks masks = cull::build_object_masks(bvh, {}, 2);
  std::vector<Ray> rays;
  for (const Vec3& target : aimed_points(mesh, random)) {
    rays.push_back(from_inside(middle, target, random));
    rays.push_back(from_outside(middle, target, 3, random));
    rays.push_back(from_outside(middle, target, 1e3f, random));
  }
  const reference::FastTracer fast(bvh);
  std::uint64_t fast_leaks = 0;
  for (const Ray& ray : rays) fast_leaks += fast.closest(ray).primitive == intersect::kNoPrimitive;
  EXPECT_EQ(fast_leaks, 0u) << name << ", fast, of " << rays.size() << " rays";
  for (const Design design : {Design::None, Design::Ideal, Design::MaskLut, Design::Projection, Design::Comparators}) {
    const cull::MaskTester tester(design, {});
    const reference::Traversal traversal(bvh, &masks, tester);
    std::uint64_t leaks = 0, other_surface = 0;
    for (const Ray& ray : rays) {
      const auto hit = traversal.trace(ray);
      leaks += hit.primitive == intersect::kNoPrimitive;
      // The aimed point lies at t = 1; a hit well behind it went through a hole of the near surface.
      other_surface += hit.primitive != intersect::kNoPrimitive && hit.t > 1.02f;
    }
    EXPECT_EQ(leaks, 0u) << name << ", " << to_string(design) << ", of " << rays.size() << " rays";
    EXPECT_EQ(other_surface, 0u) << name << ", " << to_string(design) << ", of " << rays.size() << " rays";
  }
}

class WatertightTest : public ::testing::Test {
 protected:
  ::testing::ScopedTrace seed_{__FILE__, __LINE__, oracle::seed_note()};
};

TEST_F(WatertightTest, nothing_leaks_through_a_sphere) { expect_no_leak("sphere", test::icosphere(5), {0, 0, 0}); }
TEST_F(WatertightTest, nothing_leaks_through_a_lattice_cube) { expect_no_leak("cube", test::lattice_cube(40), {0, 0, 0}); }
TEST_F(WatertightTest, nothing_leaks_through_a_sphere_far_from_the_origin) {
  expect_no_leak("moved sphere", test::moved(test::icosphere(5), {1000, 2000, -3000}), {1000, 2000, -3000});
}
TEST_F(WatertightTest, nothing_leaks_through_a_cube_far_from_the_origin) {
  expect_no_leak("moved cube", test::moved(test::lattice_cube(40), {1000, 2000, -3000}), {1000, 2000, -3000});
}

}  // namespace
