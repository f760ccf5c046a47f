// kd-trees: what a leaf refers to, where planes lie, and boxes that split clipping makes smaller but never too small.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <vector>

#include "model/accel/clip.h"
#include "model/accel/kd_build.h"
#include "model/accel/leaf_record.h"
#include "model/base/error.h"
#include "model/scene/load.h"
#include "tests/accel/meshes.h"
#include "tests/oracle/rational.h"
#include "tests/oracle/seed.h"

namespace {

using namespace ctu;
using accel::KdNode;
using accel::KdTree;
using accel::LeafTriangle;
using accel::PrimitiveBox;
using oracle::exact;
using oracle::Rational;
using oracle::Vec3q;

TEST(KdTree, the_default_depths_are_those_of_the_papers_table_1) {
  EXPECT_EQ(accel::default_kd_depth(7383), 25);
  EXPECT_EQ(accel::default_kd_depth(33271), 27);
  EXPECT_EQ(accel::default_kd_depth(1087721), 34);
  EXPECT_EQ(accel::default_kd_depth(66454), 29);
  EXPECT_EQ(accel::default_kd_depth(1), 8);
}

class Dice {
 public:
  double between(double low, double high) { return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
  std::uint64_t below(std::uint64_t n) { return bits_() % n; }
  float number(double size) { return static_cast<float>(between(-size, size)); }
  Vec3 point(double size) { return {number(size), number(size), number(size)}; }
  /// A multiple of 1/64 in [0, 1].
  Rational share() { return Rational(static_cast<int>(below(65)), 64); }

 private:
  std::mt19937_64 bits_{oracle::test_seed()};
};

/// A point of a triangle, exactly.
Vec3q point_of(const LeafTriangle& t, const Rational& u, const Rational& v) {
  const Vec3q a = exact(t.v0), b = exact(t.v1), c = exact(t.v2);
  Vec3q p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = a[i] * (1 - u - v) + b[i] * u + c[i] * v;
  return p;
}

bool holds(const PrimitiveBox& box, const Vec3q& p) {
  for (int a = 0; a < 3; ++a) {
    const Rational& x = p[static_cast<std::size_t>(a)];
    if (x < exact(box.lower[a]) || x > exact(box.upper[a])) return false;
  }
  return true;
}

/// Whether a leaf whose closed cell has the point refers to the primitive, by a box that has it too.
bool is_found(const KdTree& tree, std::uint32_t node, const Vec3q& p, std::uint32_t id) {
  const KdNode& n = tree.nodes[node];
  if (n.is_leaf()) {
    for (std::uint32_t i = n.first(); i < n.first() + n.references(); ++i)
      if (tree.references[i] == id && holds(tree.box(i), p)) return true;
    return false;
  }
  const Rational& x = p[static_cast<std::size_t>(n.axis())];
  const Rational plane = exact(n.plane());
  return (x <= plane && is_found(tree, node + 1, p, id)) || (x >= plane && is_found(tree, n.upper_child(), p, id));
}

void expect_every_point_is_found(const scene::Mesh& mesh, const accel::KdOptions& options, std::uint32_t primitives) {
  const KdTree tree = accel::build_kd_tree(mesh, options);
  Dice dice;
  for (std::uint32_t i = 0; i < primitives; ++i) {
    const auto id = static_cast<std::uint32_t>(dice.below(mesh.primitives()));
    const LeafTriangle& primitive = tree.primitives[id];
    if (primitive.is_sphere()) continue;
    for (int k = 0; k < 4; ++k) {
      Rational u = dice.share(), v = dice.share();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      ASSERT_TRUE(is_found(tree, 0, point_of(primitive, u, v), id))
          << "primitive " << id << ", leaf size " << options.max_leaf_primitives << ", u " << u << ", v " << v;
    }
  }
}

TEST(KdTree, every_point_of_a_triangle_is_found_in_the_leaf_that_it_lies_in) {
  SCOPED_TRACE(oracle::seed_note());
  for (const bool clip : {false, true})
    for (const int leaf : {1, 8}) {
      expect_every_point_is_found(scene::load("gen:tilted-quads?quads=150").mesh,
                                  {.max_leaf_primitives = leaf, .clip = clip}, 200);
      expect_every_point_is_found(scene::load("gen:tetra?depth=4").mesh, {.max_leaf_primitives = leaf, .clip = clip},
                                  200);
    }
}

TEST(KdTree, hard_meshes_are_built_and_keep_their_primitives) {
  SCOPED_TRACE(oracle::seed_note());
  for (const test::NamedMesh& named : test::adversarial_meshes(oracle::test_seed())) {
    if (named.mesh.triangles.size() > 2000) continue;
    SCOPED_TRACE(named.name);
    for (const bool clip : {false, true})
      expect_every_point_is_found(named.mesh, {.max_leaf_primitives = 4, .max_depth = 12, .clip = clip}, 30);
  }
}

TEST(KdTree, a_plane_separates_two_groups_and_empty_space_is_cut_off) {
  // Two tetrahedra's worth of triangles far apart on y, the space between empty.
  scene::Mesh mesh;
  for (int group = 0; group < 2; ++group)
    for (int i = 0; i < 4; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      const float y = static_cast<float>(10 * group);
      mesh.vertices.push_back({0, y, 0});
      mesh.vertices.push_back({1, y + 1, 0});
      mesh.vertices.push_back({0, y, 1});
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  const KdTree tree = accel::build_kd_tree(mesh, {.max_leaf_primitives = 4});
  ASSERT_FALSE(tree.nodes[0].is_leaf());
  EXPECT_EQ(tree.nodes[0].axis(), 1);
  EXPECT_TRUE(tree.nodes[0].plane() == 1 || tree.nodes[0].plane() == 10);
  const accel::KdStatistics s = accel::statistics(tree);
  EXPECT_EQ(s.references, 8u);
  EXPECT_EQ(s.longest_leaf, 4u);
  EXPECT_EQ(s.nodes, 2 * s.leaves - 1);
}

TEST(KdTree, larger_leaves_make_smaller_trees_and_the_sizes_follow_table_3) {
  const scene::Mesh mesh = scene::load("gen:balls?depth=3").mesh;
  std::uint64_t nodes = ~std::uint64_t{0};
  for (const int leaf : {1, 4, 8, 16, 32}) {
    const KdTree tree = accel::build_kd_tree(mesh, {.max_leaf_primitives = leaf});
    const accel::KdStatistics s = accel::statistics(tree);
    EXPECT_LT(s.nodes, nodes);
    nodes = s.nodes;
    EXPECT_EQ(s.tree_bytes(), 8 * s.nodes + 4 * s.references);
    EXPECT_EQ(s.box_bytes, 24 * mesh.primitives());
    EXPECT_LE(tree.depth, accel::default_kd_depth(mesh.primitives()) + 1);
    EXPECT_EQ(tree.spheres, mesh.spheres.size());
  }
}

TEST(KdTree, split_clipping_refers_to_fewer_primitives_and_keeps_a_box_a_reference) {
  const scene::Mesh mesh = scene::load("gen:tilted-quads?quads=500").mesh;
  const KdTree plain = accel::build_kd_tree(mesh, {}), clipped = accel::build_kd_tree(mesh, {.clip = true});
  EXPECT_LT(accel::statistics(clipped).references, accel::statistics(plain).references);
  EXPECT_EQ(clipped.boxes.size(), clipped.references.size());
  EXPECT_EQ(plain.boxes.size(), mesh.primitives());
}

TEST(KdTree, options_out_of_range_and_meshes_that_are_none_are_refused) {
  const scene::Mesh mesh = scene::load("gen:tetra?depth=1").mesh;
  EXPECT_THROW(accel::build_kd_tree(mesh, {.max_leaf_primitives = 0}), Error);
  EXPECT_THROW(accel::build_kd_tree(mesh, {.max_depth = 65}), Error);
  EXPECT_THROW(accel::build_kd_tree(mesh, {.primitive_cost = 0}), Error);
  EXPECT_THROW(accel::build_kd_tree(mesh, {.empty_bonus = 1.5}), Error);
  EXPECT_THROW(accel::build_kd_tree({}, {}), Error);
}

std::string show(const LeafTriangle& t, const PrimitiveBox& box, int axis, float plane) {
  std::ostringstream text;
  text << std::hex;
  for (const Vec3& v : {t.v0, t.v1, t.v2, box.lower, box.upper})
    for (int a = 0; a < 3; ++a) text << " 0x" << numeric::bits(v[a]);
  text << " axis " << axis << " plane 0x" << numeric::bits(plane);
  return text.str();
}

TEST(ClippedBox, holds_every_point_of_the_triangle_on_its_side) {
  SCOPED_TRACE(oracle::seed_note());
  Dice dice;
  int inside = 0, smaller = 0;
  for (int i = 0; i < 4000; ++i) {
    const double size = std::pow(10.0, dice.between(-30, 30));
    LeafTriangle t{dice.point(size), dice.point(size), dice.point(size), 0};
    if (dice.below(4) == 0) t.v1.x = t.v0.x;
    if (dice.below(10) == 0) t.v2 = t.v1;
    const PrimitiveBox box = accel::box_of_primitive(t);
    const int axis = static_cast<int>(dice.below(3));
    const float plane = dice.below(5) == 0 ? t.v2[axis] : dice.number(size);
    for (const accel::Side side : {accel::Side::Lower, accel::Side::Upper}) {
      const auto part = accel::clipped_box(t, box, axis, plane, side);
      for (int k = 0; k < 5; ++k) {
        Rational u = dice.share(), v = dice.share();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Vec3q p = point_of(t, u, v);
        const Rational& x = p[static_cast<std::size_t>(axis)];
        if (side == accel::Side::Lower ? x > exact(plane) : x < exact(plane)) continue;
        ++inside;
        ASSERT_TRUE(part && holds(*part, p)) << show(t, box, axis, plane);
      }
      smaller += part && !(*part == box);
    }
  }
  EXPECT_GT(inside, 5000);
  EXPECT_GT(smaller, 2000);
}

TEST(ClippedBox, holds_every_point_of_the_sphere_on_its_side) {
  SCOPED_TRACE(oracle::seed_note());
  Dice dice;
  int inside = 0;
  for (int i = 0; i < 4000; ++i) {
    const double size = std::pow(10.0, dice.between(-12, 12));
    const scene::Sphere sphere{dice.point(size), std::fabs(dice.number(size))};
    const LeafTriangle p = LeafTriangle::of(sphere, 0);
    const PrimitiveBox box = accel::box_of_primitive(p);
    const int axis = static_cast<int>(dice.below(3));
    const double height = dice.between(-1, 1);
    const float plane = static_cast<float>(sphere.centre[axis] + height * static_cast<double>(sphere.radius));
    // The circle in the plane, by its points of largest extent, in rationals: squares only.
    const Rational away = exact(plane) - exact(sphere.centre[axis]);
    const Rational square = exact(sphere.radius) * exact(sphere.radius) - away * away;
    if (square < 0) continue;
    for (const accel::Side side : {accel::Side::Lower, accel::Side::Upper}) {
      const auto part = accel::clipped_box(p, box, axis, plane, side);
      ASSERT_TRUE(part) << show(p, box, axis, plane);
      ++inside;
      for (int a = 0; a < 3; ++a) {
        if (a == axis) continue;
        const Rational low = exact(sphere.centre[a]) - exact(part->lower[a]),
                       high = exact(part->upper[a]) - exact(sphere.centre[a]);
        ASSERT_TRUE(low >= 0 && low * low >= square) << show(p, box, axis, plane);
        ASSERT_TRUE(high >= 0 && high * high >= square) << show(p, box, axis, plane);
      }
      const bool keeps_centre =
          side == accel::Side::Lower ? sphere.centre[axis] <= plane : sphere.centre[axis] >= plane;
      if (keeps_centre) {
        for (int a = 0; a < 3; ++a) {
          if (a == axis) continue;
          ASSERT_EQ(part->lower[a], box.lower[a]) << show(p, box, axis, plane);
          ASSERT_EQ(part->upper[a], box.upper[a]) << show(p, box, axis, plane);
        }
      }
    }
  }
  EXPECT_GT(inside, 4000);
}

}  // namespace
