// Trees over spheres, and over spheres and triangles: every primitive once, in boxes that hold it exactly.
#include <gtest/gtest.h>

#include <cstring>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "model/accel/build.h"
#include "model/accel/image.h"
#include "model/accel/refit.h"
#include "model/base/error.h"
#include "model/scene/load.h"
#include "tests/oracle/seed.h"

namespace {

using namespace ctu;
using accel::Bvh4;
using accel::ChildRef;

scene::Mesh mixed_mesh(int triangles, int spheres) {
  std::mt19937_64 random(oracle::test_seed());
  const auto number = [&] { return static_cast<float>(static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
  scene::Mesh mesh;
  for (int i = 0; i < 3 * triangles; ++i) mesh.vertices.push_back({number(), number(), number()});
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(triangles); ++i)
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  for (int i = 0; i < spheres; ++i) {
    const float tenth = number() * 0.1f;
    mesh.spheres.push_back({{number(), number(), number()}, i % 17 == 0 ? 0 : std::fabs(tenth * tenth)});
  }
  return mesh;
}

/// In binary64 the sums of two binary32 numbers of ordinary size are exact.
bool holds(const accel::Node4& node, int lane, const accel::LeafTriangle& p) {
  for (int a = 0; a < 3; ++a) {
    const double lo = node.boxes.lo[a][lane], hi = node.boxes.hi[a][lane];
    if (p.is_sphere()) {
      const scene::Sphere s = p.sphere();
      if (double{s.centre[a]} - s.radius < lo || double{s.centre[a]} + s.radius > hi) return false;
    } else if (std::min({p.v0[a], p.v1[a], p.v2[a]}) < node.boxes.lo[a][lane] ||
               std::max({p.v0[a], p.v1[a], p.v2[a]}) > node.boxes.hi[a][lane]) {
      return false;
    }
  }
  return true;
}

void expect_all_below_hold(const Bvh4& bvh, std::vector<std::pair<std::uint32_t, int>>& path, ChildRef ref,
                           std::vector<int>& seen) {
  if (accel::is_leaf(ref)) {
    for (int i = 0; i < accel::leaf_count(ref); ++i) {
      const accel::LeafTriangle& p = bvh.triangles[accel::leaf_first(ref) + static_cast<std::uint32_t>(i)];
      ++seen[p.id()];
      for (const auto& [node, lane] : path) ASSERT_TRUE(holds(bvh.nodes[node], lane, p)) << "primitive " << p.id();
    }
    return;
  }
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    if (bvh.nodes[ref].child[lane] == accel::kEmptyChild) continue;
    path.emplace_back(ref, lane);
    expect_all_below_hold(bvh, path, bvh.nodes[ref].child[lane], seen);
    path.pop_back();
  }
}

void expect_sound(const Bvh4& bvh, std::size_t primitives) {
  std::vector<std::pair<std::uint32_t, int>> path;
  std::vector<int> seen(primitives);
  expect_all_below_hold(bvh, path, 0, seen);
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
}

TEST(TreeOfSpheres, every_primitive_is_in_one_leaf_and_all_boxes_above_hold_it) {
  SCOPED_TRACE(oracle::seed_note());
  for (const auto& [triangles, spheres] : {std::pair{0, 1}, {0, 500}, {1, 1}, {300, 700}}) {
    const scene::Mesh mesh = mixed_mesh(triangles, spheres);
    const Bvh4 bvh = accel::build(mesh, {});
    EXPECT_EQ(bvh.spheres, mesh.spheres.size());
    expect_sound(bvh, mesh.primitives());
    for (const accel::LeafTriangle& p : bvh.triangles) {
      ASSERT_EQ(p.is_sphere(), p.id() >= mesh.triangles.size());
      if (p.is_sphere()) {
        ASSERT_EQ(p.sphere(), mesh.spheres[p.id() - mesh.triangles.size()]);
      }
    }
  }
}

TEST(TreeOfSpheres, a_refit_follows_moved_spheres) {
  scene::Mesh mesh = mixed_mesh(50, 200);
  Bvh4 bvh = accel::build(mesh, {});
  for (scene::Sphere& sphere : mesh.spheres) sphere = {{sphere.centre.z, sphere.centre.x * 3, sphere.centre.y}, 0.3f};
  accel::refit(bvh, mesh, 1);
  expect_sound(bvh, mesh.primitives());
  mesh.spheres.pop_back();
  mesh.vertices.resize(3);
  mesh.triangles.push_back({0, 1, 2});
  EXPECT_THROW(accel::refit(bvh, mesh, 1), Error);
}

TEST(TreeOfSpheres, spheres_that_are_none_are_refused) {
  scene::Mesh mesh = mixed_mesh(1, 2);
  mesh.spheres[1].radius = -1;
  EXPECT_THROW(accel::build(mesh, {}), Error);
  mesh.spheres[1] = {{3e38f, 0, 0}, 3e38f};
  EXPECT_THROW(accel::build(mesh, {}), Error);
}

TEST(TreeOfSpheres, an_image_of_it_gives_the_same_tree_back_and_says_how_many_they_are) {
  const accel::Bvh4 tree = accel::build(mixed_mesh(30, 20), {});
  for (const bool boxes : {false, true}) {
    const accel::Image image = accel::make_image(tree, nullptr, 0, {.primitive_boxes = boxes});
    EXPECT_NO_THROW(accel::validate(image));
    EXPECT_EQ(image.sphere_count, tree.spheres);
    const accel::Bvh4 again = accel::decode(image);
    EXPECT_EQ(again.spheres, tree.spheres);
    ASSERT_EQ(again.triangles.size(), tree.triangles.size());
    for (std::uint32_t i = 0; i < again.triangles.size(); ++i) {
      EXPECT_EQ(std::memcmp(&again.triangles[i], &tree.triangles[i], sizeof tree.triangles[i]), 0) << i;
      if (boxes) EXPECT_EQ(accel::read_primitive_box(image, i), accel::box_of_primitive(tree.triangles[i])) << i;
    }
    if (!boxes) EXPECT_THROW(accel::read_primitive_box(image, 0), Error);
  }
}

}  // namespace
