// Several trees in one: each stays what it is alone, in the arrays and in the image, in any order of the nodes.
#include "model/accel/forest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "model/accel/build.h"
#include "model/accel/image.h"
#include "model/accel/partition.h"
#include "model/base/error.h"
#include "tests/accel/bits.h"
#include "tests/accel/meshes.h"
#include "tests/oracle/seed.h"

namespace {

using namespace ctu;
using accel::Bvh4;
using accel::ChildRef;
using accel::Image;

std::vector<Bvh4> trees() {
  std::vector<Bvh4> all;
  for (const test::NamedMesh& m : test::adversarial_meshes(oracle::test_seed()))
    if (m.name == "soup")
      for (const int leaf : {4, 1, 15}) all.push_back(accel::build(m.mesh, {.max_leaf_triangles = leaf}));
  return all;
}

Bvh4 forest() {
  const std::vector<Bvh4> all = trees();
  Bvh4 forest = all[0];
  for (std::size_t i = 1; i < all.size(); ++i) accel::append_tree(forest, all[i]);
  return forest;
}

/// Primitives from a root on, depth first: what a tree holds and in which order, wherever it lies.
std::vector<std::uint32_t> primitives_below(const Bvh4& bvh, ChildRef root) {
  std::vector<std::uint32_t> found;
  const std::function<void(ChildRef)> visit = [&](ChildRef ref) {
    if (ref == accel::kEmptyChild) return;
    if (accel::is_leaf(ref)) {
      for (int i = 0; i < accel::leaf_count(ref); ++i)
        found.push_back(bvh.triangles[accel::leaf_first(ref) + static_cast<unsigned>(i)].primitive);
      return;
    }
    for (const ChildRef child : bvh.nodes[ref].child) visit(child);
  };
  visit(root);
  return found;
}

TEST(Forest, each_tree_holds_in_the_same_order_what_it_holds_alone) {
  const std::vector<Bvh4> all = trees();
  const Bvh4 bvh = forest();
  ASSERT_EQ(bvh.trees(), 3u);
  int depth = 0;
  std::size_t nodes = 0;
  for (std::uint32_t tree = 0; tree < 3; ++tree) {
    EXPECT_EQ(primitives_below(bvh, bvh.root(tree)), primitives_below(all[tree], 0)) << tree;
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < intersect::kLanes; ++lane)
        EXPECT_EQ(bvh.nodes[bvh.root(tree)].boxes.lo[axis][lane], all[tree].nodes[0].boxes.lo[axis][lane]);
    depth = std::max(depth, all[tree].depth);
    nodes += all[tree].nodes.size();
  }
  EXPECT_EQ(bvh.depth, depth);
  EXPECT_EQ(bvh.nodes.size(), nodes);
  EXPECT_EQ(bvh.lower, all[0].lower);
}

TEST(Forest, an_image_of_it_is_valid_and_gives_it_back) {
  const Bvh4 bvh = forest();
  const Image image = accel::make_image(bvh, nullptr, 0, {});
  EXPECT_NO_THROW(accel::validate(image));
  EXPECT_EQ(image.further_roots, bvh.further_roots);
  const Bvh4 back = accel::decode(image);
  EXPECT_EQ(back.further_roots, bvh.further_roots);
  ASSERT_EQ(back.nodes.size(), bvh.nodes.size());
  for (std::size_t n = 0; n < bvh.nodes.size(); ++n) ASSERT_TRUE(test::same_node(back.nodes[n], bvh.nodes[n])) << n;
}

TEST(Forest, bare_nodes_come_last_but_no_root_is_one_and_the_trees_stay) {
  const Bvh4 before = forest();
  std::mt19937_64 random(oracle::test_seed());
  std::vector<bool> carries(before.nodes.size());
  for (std::size_t n = 0; n < carries.size(); ++n) carries[n] = random() % 3 == 0;
  Bvh4 after = before;
  const accel::Partition partition = accel::partition_nodes(after, carries);
  ASSERT_GT(partition.bare_nodes, 0u);
  for (std::uint32_t tree = 0; tree < 3; ++tree) {
    EXPECT_LT(after.root(tree), after.nodes.size() - partition.bare_nodes);
    EXPECT_EQ(primitives_below(after, after.root(tree)), primitives_below(before, before.root(tree)));
  }
  const std::vector<std::uint64_t> masks(after.nodes.size() * 4, ~std::uint64_t{0});
  EXPECT_NO_THROW(accel::validate(
      accel::make_image(after, masks.data(), 1, {.mask_bits = 64, .bare_nodes = partition.bare_nodes})));
}

TEST(Forest, roots_that_are_none_are_refused) {
  const Bvh4 bvh = forest();
  const Image good = accel::make_image(bvh, nullptr, 0, {});
  const auto refused = [&](const std::vector<ChildRef>& roots, const char* why) {
    Image bad = good;
    bad.further_roots = roots;
    EXPECT_THROW(accel::validate(bad), Error) << why;
  };
  const ChildRef second = bvh.root(1), third = bvh.root(2);
  refused({}, "the nodes of two trees are left over");
  refused({second}, "those of one are");
  refused({second, third, third}, "one root twice");
  refused({0, second, third}, "the first root twice");
  refused({second, third, third + 1}, "an inner node with a parent");
  refused({second, static_cast<ChildRef>(bvh.nodes.size())}, "no node");
  refused({second, accel::kEmptyChild}, "nothing");
  refused({second, accel::make_leaf(0, 1)}, "a leaf");
  refused(std::vector<ChildRef>(accel::kMostTrees, second), "more than there may be");
}

TEST(Forest, of_more_trees_than_a_ray_can_name_is_refused) {
  const std::vector<Bvh4> all = trees();
  Bvh4 bvh = all[0];
  Bvh4 small;
  small.nodes.resize(1);
  for (std::uint32_t i = 1; i < accel::kMostTrees; ++i) accel::append_tree(bvh, small);
  EXPECT_EQ(bvh.trees(), accel::kMostTrees);
  EXPECT_THROW(accel::append_tree(bvh, small), Error);
}

}  // namespace
