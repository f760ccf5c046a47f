// Laws of every tree, whatever the mesh: nothing lost, boxes exact, leaves and depth within limits, threads invisible.
#include "model/accel/build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "model/accel/statistics.h"
#include "model/base/error.h"
#include "tests/accel/bits.h"
#include "tests/accel/lane_bounds.h"
#include "tests/accel/meshes.h"
#include "tests/oracle/seed.h"

namespace {

using namespace ctu;
using accel::Bvh4;
using accel::ChildRef;
using test::Bounds;
using test::lane_bounds;
using test::NamedMesh;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

const std::vector<NamedMesh>& meshes() {
  static const std::vector<NamedMesh> all = test::adversarial_meshes(oracle::test_seed());
  return all;
}

/// Runs `check` on the tree of every mesh.
template <class Check>
void for_each_tree(const accel::BuildOptions& options, Check&& check) {
  SCOPED_TRACE(oracle::seed_note());
  for (const NamedMesh& m : meshes()) {
    SCOPED_TRACE(m.name);
    check(m.mesh, accel::build(m.mesh, options));
  }
}

/// Checks that every lane's box is that of the vertices below it; returns those of the node.
Bounds check_boxes(const Bvh4& bvh, std::uint32_t n) {
  const accel::Node4& node = bvh.nodes[n];
  Bounds whole;
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    const ChildRef child = node.child[lane];
    Bounds below;
    if (accel::is_leaf(child)) {
      for (int i = 0; i < accel::leaf_count(child); ++i) {
        const accel::LeafTriangle& t = bvh.triangles[accel::leaf_first(child) + static_cast<std::uint32_t>(i)];
        for (const Vec3& v : {t.v0, t.v1, t.v2}) below.grow(v);
      }
    } else if (child != accel::kEmptyChild) {
      below = check_boxes(bvh, child);
    }
    EXPECT_EQ(lane_bounds(node, lane), below) << "node " << n << " lane " << lane;
    if (child == accel::kEmptyChild) continue;
    whole.grow(below.lower);
    whole.grow(below.upper);
  }
  return whole;
}

int depth_below(const Bvh4& bvh, std::uint32_t n) {
  int deepest = 0;
  for (const ChildRef child : bvh.nodes[n].child)
    if (accel::is_inner(child)) deepest = std::max(deepest, depth_below(bvh, child));
  return deepest + 1;
}

bool same_tree(const Bvh4& a, const Bvh4& b) {
  return std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), test::same_node) &&
         test::same_triangles(a.triangles, b.triangles) && a.depth == b.depth && a.lower == b.lower &&
         a.upper == b.upper;
}

TEST(Build, puts_every_triangle_into_exactly_one_leaf) {
  for_each_tree({}, [](const scene::Mesh& mesh, const Bvh4& bvh) {
    std::vector<int> seen(mesh.triangles.size(), 0);
    for (const accel::Node4& node : bvh.nodes) {
      for (const ChildRef child : node.child) {
        if (!accel::is_leaf(child)) continue;
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(accel::leaf_count(child)); ++i)
          ++seen.at(bvh.triangles.at(accel::leaf_first(child) + i).primitive);
      }
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  });
}

TEST(Build, keeps_the_vertices_of_every_triangle_to_the_bit) {
  for_each_tree({}, [](const scene::Mesh& mesh, const Bvh4& bvh) {
    ASSERT_EQ(bvh.triangles.size(), mesh.triangles.size());
    for (const accel::LeafTriangle& t : bvh.triangles) {
      const auto& c = mesh.triangles.at(t.primitive);
      const accel::LeafTriangle expected{mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]], t.primitive};
      ASSERT_TRUE(test::same_bits(expected, t)) << "triangle " << t.primitive;
    }
  });
}

TEST(Build, makes_every_box_the_exact_bounds_of_what_is_below_it) {
  for_each_tree({}, [](const scene::Mesh&, const Bvh4& bvh) {
    const Bounds whole = check_boxes(bvh, 0);
    EXPECT_EQ(whole.lower, bvh.lower);
    EXPECT_EQ(whole.upper, bvh.upper);
  });
}

TEST(Build, puts_children_after_parents_and_empty_lanes_last) {
  for_each_tree({}, [](const scene::Mesh&, const Bvh4& bvh) {
    std::vector<int> parents(bvh.nodes.size(), 0);
    for (std::uint32_t n = 0; n < bvh.nodes.size(); ++n) {
      bool empty = false;
      for (const ChildRef child : bvh.nodes[n].child) {
        EXPECT_FALSE(empty && child != accel::kEmptyChild) << "node " << n;
        empty = empty || child == accel::kEmptyChild;
        if (!accel::is_inner(child)) continue;
        EXPECT_GT(child, n);
        ++parents.at(child);
      }
    }
    EXPECT_EQ(std::count(parents.begin() + 1, parents.end(), 1), static_cast<std::ptrdiff_t>(parents.size()) - 1);
  });
}

TEST(Build, never_exceeds_the_leaf_limit) {
  for (const int limit : {1, 2, 4, 15}) {
    accel::BuildOptions options;
    options.max_leaf_triangles = limit;
    options.triangle_cost = 0.01f;  // leaves as large as they may be
    for_each_tree(options, [limit](const scene::Mesh&, const Bvh4& bvh) {
      const accel::TreeStatistics s = accel::statistics(bvh);
      for (int size = limit + 1; size <= accel::kMaxLeafTriangles; ++size)
        EXPECT_EQ(s.leaves_of_size[static_cast<std::size_t>(size)], 0u);
    });
  }
}

TEST(Build, is_the_same_tree_with_any_number_of_threads) {
  for (const NamedMesh& m : meshes()) {
    SCOPED_TRACE(m.name);
    accel::BuildOptions options;
    const Bvh4 one = accel::build(m.mesh, options);
    for (const int threads : {2, 3, 8}) {
      options.threads = threads;
      EXPECT_TRUE(same_tree(one, accel::build(m.mesh, options))) << threads << " threads";
    }
  }
}

TEST(Build, bounds_the_depth_by_twice_the_logarithm) {
  for_each_tree({}, [](const scene::Mesh& mesh, const Bvh4& bvh) {
    const int logarithm = std::bit_width(mesh.triangles.size() - 1);
    EXPECT_LE(bvh.depth, 2 * logarithm + 9);
    EXPECT_EQ(bvh.depth, depth_below(bvh, 0));
  });
}

TEST(Build, halves_equal_triangles_evenly) {
  // Nothing tells 4096 equal triangles apart: an even tree of leaves of 4 has 1024 leaves, five levels of 4-wide nodes.
  const Bvh4 bvh = accel::build(test::equal_triangles(4096), {});
  EXPECT_EQ(bvh.nodes.size(), 1u + 4 + 16 + 64 + 256);
  EXPECT_EQ(bvh.depth, 5);
}

TEST(Build, is_unchanged_by_scaling_with_a_power_of_two) {
  for (const float scale : {0x1p-40f, 0x1p-3f, 0x1p60f}) {
    const NamedMesh& m =
        *std::find_if(meshes().begin(), meshes().end(), [](const NamedMesh& n) { return n.name == "quads"; });
    scene::Mesh scaled = m.mesh;
    for (Vec3& v : scaled.vertices) v = {v.x * scale, v.y * scale, v.z * scale};
    const Bvh4 a = accel::build(m.mesh, {}), b = accel::build(scaled, {});
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t n = 0; n < a.nodes.size(); ++n)
      ASSERT_TRUE(std::equal(a.nodes[n].child, a.nodes[n].child + intersect::kLanes, b.nodes[n].child)) << "node " << n;
    for (std::size_t i = 0; i < a.triangles.size(); ++i) ASSERT_EQ(a.triangles[i].primitive, b.triangles[i].primitive);
  }
}

TEST(Build, costs_less_by_the_surface_area_heuristic_than_a_tree_of_medians) {
  // Two bins are little better than halving; sixteen must pay on scenes with structure.
  accel::BuildOptions coarse;
  coarse.bins = 2;
  for (const NamedMesh& m : meshes()) {
    if (m.name != "hair" && m.name != "quads" && m.name != "giant among tiny") continue;
    EXPECT_LT(accel::statistics(accel::build(m.mesh, {})).sah_cost,
              accel::statistics(accel::build(m.mesh, coarse)).sah_cost)
        << m.name;
  }
}

TEST(Build, refuses_what_it_cannot_build) {
  const scene::Mesh good = test::equal_triangles(3);
  scene::Mesh mesh = good;
  mesh.triangles.clear();
  EXPECT_THROW(accel::build(mesh, {}), Error);
  mesh = good;
  mesh.triangles[2][1] = 3;
  EXPECT_THROW(accel::build(mesh, {}), Error);
  for (const float bad : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
    mesh = good;
    mesh.vertices[1].z = bad;
    EXPECT_THROW(accel::build(mesh, {}), Error);
  }
  for (const int limit : {0, 16, -1}) EXPECT_THROW(accel::build(good, {.max_leaf_triangles = limit}), Error);
  for (const int bins : {1, 65}) EXPECT_THROW(accel::build(good, {.bins = bins}), Error);
  EXPECT_THROW(accel::build(good, {.node_cost = -1}), Error);
}

TEST(Build, names_the_triangle_that_is_wrong) {
  scene::Mesh mesh = test::equal_triangles(7);
  mesh.vertices.push_back({0, kInfinity, 0});
  mesh.triangles[5] = {0, 1, 3};
  try {
    accel::build(mesh, {});
    FAIL() << "an infinite vertex was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "mesh, triangle 5");
  }
}

}  // namespace
