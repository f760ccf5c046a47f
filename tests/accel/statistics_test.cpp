// The counts and the cost of a tree small enough to reckon by hand.
#include "model/accel/statistics.h"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace ctu;

void set_box(accel::Node4& node, int lane, const Vec3& lower, const Vec3& upper, accel::ChildRef child) {
  for (int axis = 0; axis < 3; ++axis) {
    node.boxes.lo[axis][lane] = lower[axis];
    node.boxes.hi[axis][lane] = upper[axis];
  }
  node.child[lane] = child;
}

accel::Node4 empty_node() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  accel::Node4 node;
  for (int lane = 0; lane < intersect::kLanes; ++lane)
    set_box(node, lane, {kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, accel::kEmptyChild);
  return node;
}

/// Root 2x2x2 (area 24): a leaf of three in 1x1x1 (area 6) and a node in 2x1x1 (area 10) with leaves of one and two in
/// cubes of area 6.
accel::Bvh4 small_tree() {
  accel::Bvh4 bvh;
  bvh.nodes = {empty_node(), empty_node()};
  bvh.triangles.resize(6);
  bvh.lower = {0, 0, 0};
  bvh.upper = {2, 2, 2};
  bvh.depth = 2;
  set_box(bvh.nodes[0], 0, {0, 1, 1}, {1, 2, 2}, accel::make_leaf(0, 3));
  set_box(bvh.nodes[0], 1, {0, 0, 0}, {2, 1, 1}, 1);
  set_box(bvh.nodes[1], 0, {0, 0, 0}, {1, 1, 1}, accel::make_leaf(3, 1));
  set_box(bvh.nodes[1], 1, {1, 0, 0}, {2, 1, 1}, accel::make_leaf(4, 2));
  return bvh;
}

TEST(Statistics, counts_nodes_leaves_and_lanes) {
  const accel::TreeStatistics s = accel::statistics(small_tree());
  EXPECT_EQ(s.nodes, 2u);
  EXPECT_EQ(s.leaves, 3u);
  EXPECT_EQ(s.triangles, 6u);
  EXPECT_EQ(s.filled_lanes, 4u);
  EXPECT_EQ(s.depth, 2);
  EXPECT_EQ(s.leaves_of_size[1], 1u);
  EXPECT_EQ(s.leaves_of_size[2], 1u);
  EXPECT_EQ(s.leaves_of_size[3], 1u);
}

TEST(Statistics, reckons_the_cost_of_equation_1) {
  const double nodes = 24 + 10, triangles = 6 * 3 + 6 * 1 + 6 * 2;
  EXPECT_DOUBLE_EQ(accel::statistics(small_tree()).sah_cost, (nodes + triangles) / 24);
  EXPECT_DOUBLE_EQ(accel::statistics(small_tree(), 3, 0.5).sah_cost, (3 * nodes + 0.5 * triangles) / 24);
}

TEST(Statistics, gives_no_cost_to_a_scene_without_area) {
  accel::Bvh4 bvh = small_tree();
  bvh.upper = bvh.lower;
  EXPECT_EQ(accel::statistics(bvh).sah_cost, 0);
}

}  // namespace
