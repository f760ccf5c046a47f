// Rays that must cross a closed mesh, against all of its triangles: none may leak, neither by the triangle test alone
// nor when each triangle stands behind the tightest box there is, its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "model/intersect/slab_test.h"
#include "model/intersect/triangle_test.h"
#include "tests/oracle/seed.h"
#include "tests/support/aimed_rays.h"

namespace ctu::intersect {
namespace {

using test::AimedRays;
using test::ClosedMesh;
using test::Family;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kRaysPerFamily = 500;

/// Four triangles' own boxes side by side.
std::vector<Box4> own_boxes(const scene::Mesh& mesh) {
  std::vector<Box4> boxes((mesh.triangles.size() + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < boxes.size() * kLanes; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      float &lo = boxes[i / kLanes].lo[axis][i % kLanes], &hi = boxes[i / kLanes].hi[axis][i % kLanes];
      lo = kInfinity, hi = -kInfinity;
      if (i >= mesh.triangles.size()) continue;
      for (const std::uint32_t v : mesh.triangles[i]) {
        lo = std::min(lo, mesh.vertices[v][axis]);
        hi = std::max(hi, mesh.vertices[v][axis]);
      }
    }
  }
  return boxes;
}

struct Crossing {
  bool by_triangles = false, behind_boxes = false;
};

Crossing cross(const ClosedMesh& closed, const std::vector<Box4>& boxes, const Ray& ray) {
  const PreparedRay prepared = prepare_ray(ray);
  EXPECT_TRUE(prepared.valid);
  Crossing crossing;
  SlabTimes times;
  for (std::size_t i = 0; i < closed.mesh.triangles.size(); ++i) {
    if (i % kLanes == 0) slab_test_outer(prepared, boxes[i / kLanes], ray.tmax, times);
    const auto& [a, b, c] = closed.mesh.triangles[i];
    const auto& v = closed.mesh.vertices;
    if (!triangle_test(prepared, v[a], v[b], v[c], ray.tmax).hit) continue;
    crossing.by_triangles = true;
    crossing.behind_boxes = crossing.behind_boxes || (times.hit >> (i % kLanes) & 1);
  }
  return crossing;
}

void expect_no_leak(const std::string& name, const ClosedMesh& closed) {
  SCOPED_TRACE(oracle::seed_note());
  const std::vector<Box4> boxes = own_boxes(closed.mesh);
  AimedRays source(closed, oracle::test_seed());
  int leaks_alone = 0, leaks_behind_boxes = 0, rays = 0;
  for (const Family family : test::kFamilies) {
    for (int i = 0; i < kRaysPerFamily; ++i, ++rays) {
      const Ray ray = source.next(family);
      const Crossing crossing = cross(closed, boxes, ray);
      leaks_alone += !crossing.by_triangles;
      leaks_behind_boxes += !crossing.behind_boxes;
      EXPECT_TRUE(crossing.behind_boxes) << name << ", " << test::to_string(family) << ", ray " << i;
    }
  }
  std::printf("%s: %zu triangles, %d aimed rays, leaks %d by triangles alone, %d behind boxes\n", name.c_str(),
              closed.mesh.triangles.size(), rays, leaks_alone, leaks_behind_boxes);
  EXPECT_EQ(leaks_alone, 0);
}

TEST(Watertight, a_sphere_leaks_no_aimed_ray) { expect_no_leak("sphere", test::closed_sphere(3)); }
TEST(Watertight, a_lattice_cube_leaks_no_aimed_ray) { expect_no_leak("cube", test::closed_cube(10)); }
TEST(Watertight, a_sphere_far_away_leaks_no_aimed_ray) {
  expect_no_leak("moved sphere", test::moved(test::closed_sphere(3)));
}
TEST(Watertight, a_lattice_cube_far_away_leaks_no_aimed_ray) {
  expect_no_leak("moved cube", test::moved(test::closed_cube(10)));
}
TEST(Watertight, a_tiny_sphere_leaks_no_aimed_ray) {
  expect_no_leak("sphere of size 1e-15", test::scaled(test::closed_sphere(3), 1e-15f));
}
TEST(Watertight, a_tiny_cube_leaks_no_aimed_ray) {
  expect_no_leak("cube of size 1e-30", test::scaled(test::closed_cube(10), 1e-30f));
}
TEST(Watertight, a_huge_sphere_leaks_no_aimed_ray) {
  expect_no_leak("sphere of size 1e15", test::scaled(test::closed_sphere(3), 1e15f));
}
TEST(Watertight, a_huge_cube_leaks_no_aimed_ray) {
  expect_no_leak("cube of size 1e27", test::scaled(test::closed_cube(10), 1e27f));
}

}  // namespace
}  // namespace ctu::intersect
