// Laws of a refit: exact boxes, nothing else changed, and what is said to have changed is what has.
#include "model/accel/refit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/scene/load.h"
#include "tests/accel/bits.h"
#include "tests/accel/lane_bounds.h"
#include "tests/accel/meshes.h"
#include "tests/oracle/seed.h"
#include "tests/support/motions.h"

namespace {

using namespace ctu;
using accel::Bvh4;
using accel::ChildRef;
using test::Bounds;
using test::lane_bounds;
using test::Motion;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool same_tree(const Bvh4& a, const Bvh4& b) {
  return std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), test::same_node) &&
         test::same_triangles(a.triangles, b.triangles) && test::same_bits(a.lower, b.lower) &&
         test::same_bits(a.upper, b.upper) && a.depth == b.depth;
}

/// Calls `body(mesh before, mesh after)` for every motion of meshes of many kinds.
template <class Body>
void for_each_motion(Body&& body) {
  SCOPED_TRACE(oracle::seed_note());
  for (const test::NamedMesh& m : test::adversarial_meshes(oracle::test_seed()))
    for (const Motion motion : test::kMotions) {
      if (m.mesh.triangles.size() > 5000 && motion != Motion::Dent) continue;
      SCOPED_TRACE(m.name + ", " + to_string(motion));
      body(m.mesh, test::moved(m.mesh, motion, oracle::test_seed()));
    }
}

/// Every triangle below a child.
void collect(const Bvh4& bvh, ChildRef ref, std::vector<std::size_t>& out) {
  if (accel::is_leaf(ref))
    for (int i = 0; i < accel::leaf_count(ref); ++i) out.push_back(accel::leaf_first(ref) + static_cast<unsigned>(i));
  else if (accel::is_inner(ref))
    for (const ChildRef child : bvh.nodes[ref].child) collect(bvh, child, out);
}

TEST(Refit, given_unmoved_vertices_then_the_tree_is_the_same_to_the_bit_and_nothing_has_changed) {
  for (const test::NamedMesh& m : test::adversarial_meshes(oracle::test_seed())) {
    SCOPED_TRACE(m.name);
    const Bvh4 built = accel::build(m.mesh, {});
    Bvh4 tree = built;
    const accel::RefitChanges changes = accel::refit(tree, m.mesh, 2);
    EXPECT_TRUE(same_tree(tree, built));
    for (std::uint32_t node = 0; node < tree.nodes.size(); ++node) ASSERT_FALSE(changes.any(node)) << "node " << node;
  }
}

TEST(Refit, every_box_is_that_of_the_moved_vertices_below_it) {
  for_each_motion([](const scene::Mesh& before, const scene::Mesh& after) {
    Bvh4 tree = accel::build(before, {});
    accel::refit(tree, after, 1);
    Bounds scene;
    for (const accel::LeafTriangle& t : tree.triangles) {
      const auto& corners = after.triangles[t.primitive];
      ASSERT_TRUE(test::same_bits(t.v0, after.vertices[corners[0]]) &&
                  test::same_bits(t.v1, after.vertices[corners[1]]) &&
                  test::same_bits(t.v2, after.vertices[corners[2]]));
      for (const Vec3& v : {t.v0, t.v1, t.v2}) scene.grow(v);
    }
    EXPECT_EQ(scene, (Bounds{tree.lower, tree.upper}));
    for (std::uint32_t node = 0; node < tree.nodes.size(); ++node)
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        std::vector<std::size_t> below;
        if (tree.nodes[node].child[lane] != accel::kEmptyChild) collect(tree, tree.nodes[node].child[lane], below);
        Bounds expected;
        for (const std::size_t i : below)
          for (const Vec3& v : {tree.triangles[i].v0, tree.triangles[i].v1, tree.triangles[i].v2}) expected.grow(v);
        ASSERT_EQ(lane_bounds(tree.nodes[node], lane), expected) << "node " << node << ", lane " << lane;
      }
  });
}

TEST(Refit, a_child_has_changed_if_and_only_if_its_bits_or_those_of_a_triangle_below_it_have) {
  for_each_motion([](const scene::Mesh& before, const scene::Mesh& after) {
    const Bvh4 old = accel::build(before, {});
    Bvh4 tree = old;
    const accel::RefitChanges changes = accel::refit(tree, after, 2);
    ASSERT_EQ(changes.nodes(), tree.nodes.size());
    for (std::uint32_t node = 0; node < tree.nodes.size(); ++node) {
      ASSERT_TRUE(std::equal(tree.nodes[node].child, tree.nodes[node].child + 4, old.nodes[node].child));
      bool any = false;
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        std::vector<std::size_t> below;
        if (old.nodes[node].child[lane] != accel::kEmptyChild) collect(old, old.nodes[node].child[lane], below);
        const bool moved = std::any_of(below.begin(), below.end(), [&](std::size_t i) {
          return !test::same_bits(tree.triangles[i], old.triangles[i]);
        });
        const Bounds a = lane_bounds(old.nodes[node], lane), b = lane_bounds(tree.nodes[node], lane);
        ASSERT_EQ(changes.moved(node, lane), moved) << "node " << node << ", lane " << lane;
        ASSERT_EQ(changes.box(node, lane), !test::same_bits(a, b)) << "node " << node << ", lane " << lane;
        any |= moved;
      }
      ASSERT_EQ(changes.any(node), any) << "node " << node;
    }
  });
}

TEST(Refit, given_vertices_moved_there_and_back_then_the_tree_is_as_built) {
  for_each_motion([](const scene::Mesh& before, const scene::Mesh& after) {
    const Bvh4 built = accel::build(before, {});
    Bvh4 tree = built;
    accel::refit(tree, after, 2);
    accel::refit(tree, before, 2);
    EXPECT_TRUE(same_tree(tree, built));
  });
}

TEST(Refit, the_number_of_threads_is_invisible) {
  const scene::Mesh mesh = scene::load("gen:hair-ball?strands=3000").mesh;
  const scene::Mesh after = test::moved(mesh, Motion::Scattered, oracle::test_seed());
  const Bvh4 built = accel::build(mesh, {});
  Bvh4 one = built;
  accel::refit(one, after, 1);
  for (const int threads : {2, 7}) {
    Bvh4 tree = built;
    accel::refit(tree, after, threads);
    EXPECT_TRUE(same_tree(tree, one));
  }
}

TEST(Refit, given_a_mesh_of_another_size_or_a_vertex_missing_or_not_finite_then_an_error_and_the_tree_as_it_was) {
  const scene::Mesh mesh = scene::load("gen:tetra?depth=4").mesh;
  const Bvh4 built = accel::build(mesh, {});
  std::vector<scene::Mesh> bad(5, mesh);
  bad[0].triangles.pop_back();
  bad[1].triangles.push_back({0, 1, 2});
  bad[2].vertices.pop_back();
  bad[3].vertices.back().y = std::numeric_limits<float>::quiet_NaN();
  bad[4].vertices.back().x = kInfinity;
  bad[4].vertices.front().x = 100;
  for (const scene::Mesh& wrong : bad) {
    Bvh4 tree = built;
    EXPECT_THROW(accel::refit(tree, wrong, 2), Error);
    EXPECT_TRUE(same_tree(tree, built));
  }
  Bvh4 none;
  EXPECT_EQ(accel::refit(none, {}, 1).nodes(), 0u);
}

}  // namespace
