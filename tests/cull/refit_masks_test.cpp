// A refit of object masks is a fresh build on the refitted tree, for every R and L.
#include "model/cull/refit_masks.h"

#include <gtest/gtest.h>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/scene/load.h"
#include "tests/oracle/seed.h"
#include "tests/support/motions.h"
#include "tests/support/real_scenes.h"

namespace ctu::cull {
namespace {

using test::Motion;

/// "node 7, lane 2: 0123456789abcdef, not ...", or nothing when they are equal.
std::string first_difference(const ObjectMasks& found, const ObjectMasks& expected) {
  if (found.bits.size() != expected.bits.size()) return "another number of words";
  for (std::size_t i = 0; i < found.bits.size(); ++i)
    if (found.bits[i] != expected.bits[i]) {
      const std::size_t child = i / static_cast<std::size_t>(found.words);
      char text[120];
      std::snprintf(text, sizeof text, "node %zu, lane %zu: %016llx, not %016llx", child / 4, child % 4,
                    static_cast<unsigned long long>(found.bits[i]), static_cast<unsigned long long>(expected.bits[i]));
      return text;
    }
  return "";
}

/// Moves the mesh in every way, one after the other, and refits the same tree and masks all along.
void expect_refits_are_builds(const scene::Mesh& mesh, const MaskOptions& options) {
  SCOPED_TRACE("R " + std::to_string(options.resolution) + ", L " + std::to_string(options.levels));
  accel::Bvh4 tree = accel::build(mesh, {});
  const accel::Bvh4 built = tree;
  ObjectMasks one = build_object_masks(tree, options, 1), many = one;
  scene::Mesh now = mesh;
  std::uint64_t seed = oracle::test_seed();
  for (const Motion motion : test::kMotions) {
    // What has been flattened or lies in one cell would make the later motions easy.
    if (motion == Motion::Twist || motion == Motion::Reorder) now = mesh;
    now = test::moved(now, motion, ++seed);
    const accel::RefitChanges changes = accel::refit(tree, now, 1);
    refit_object_masks(one, tree, changes, options, 1);
    refit_object_masks(many, tree, changes, options, 3);
    const ObjectMasks fresh = build_object_masks(tree, options, 1);
    ASSERT_EQ(first_difference(one, fresh), "") << to_string(motion);
    ASSERT_EQ(first_difference(many, fresh), "") << to_string(motion) << ", 3 threads";
  }
}

class RefitMasks : public testing::TestWithParam<const char*> {};

TEST_P(RefitMasks, are_those_of_a_fresh_build_for_every_r_and_l) {
  SCOPED_TRACE(oracle::seed_note());
  const scene::Mesh mesh = scene::load(GetParam()).mesh;
  for (int r = kMinResolution; r <= kMaxResolution; ++r)
    for (const int levels : {kUnlimitedLevels, 1, 2, 3, 4, 5})
      expect_refits_are_builds(mesh, {.resolution = r, .ray_resolution = r, .levels = levels});
}

INSTANTIATE_TEST_SUITE_P(GeneratedScenes, RefitMasks,
                         testing::Values("gen:hair-ball?strands=60", "gen:tilted-quads?quads=300", "gen:tetra?depth=4",
                                         "gen:foliage?twigs=20"));

// Large enough for the tree to be cut, and the refit's too.
TEST(RefitMasksOfLargeTrees, are_those_of_a_fresh_build) {
  SCOPED_TRACE(oracle::seed_note());
  const scene::Mesh mesh = scene::load("gen:tilted-quads?quads=12000&size=0.02").mesh;
  expect_refits_are_builds(mesh, {.resolution = 6, .ray_resolution = 6});
  expect_refits_are_builds(mesh, {.levels = 2});
}

TEST(RefitMasksOfRealScenes, of_the_bunny_are_those_of_a_fresh_build) {
  SCOPED_TRACE(oracle::seed_note());
  const std::filesystem::path folder = test::unpacked_scenes();
  if (folder.empty()) GTEST_SKIP() << "no shared scenes: set CTU_SCENES to their folder";
  const scene::Mesh mesh = scene::load((folder / "bunny/bunny.ply.zst").string()).mesh;
  for (const int levels : {kUnlimitedLevels, 3}) expect_refits_are_builds(mesh, {.levels = levels});
}

TEST(RefitMasksAlone, given_a_child_below_which_nothing_moved_then_its_mask_is_not_touched) {
  SCOPED_TRACE(oracle::seed_note());
  const scene::Mesh mesh = scene::load("gen:tilted-quads?quads=6000&size=0.02").mesh;
  accel::Bvh4 tree = accel::build(mesh, {});
  ObjectMasks masks = build_object_masks(tree, {}, 1);
  const accel::RefitChanges changes = accel::refit(tree, test::moved(mesh, Motion::Dent, oracle::test_seed()), 1);
  // With L unlimited no mask depends on another.
  std::size_t kept = 0;
  const auto for_each_kept = [&](auto body) {
    for (std::uint32_t node = 0; node < tree.nodes.size(); ++node)
      for (int lane = 0; lane < intersect::kLanes; ++lane)
        if (!changes.moved(node, lane)) body(masks.bits[node * std::size_t{4} + static_cast<std::size_t>(lane)]);
  };
  for_each_kept([](std::uint64_t& mask) { mask = 0x5a5a; });
  refit_object_masks(masks, tree, changes, {}, 2);
  for_each_kept([&](std::uint64_t& mask) {
    ASSERT_EQ(mask, 0x5a5au);
    ++kept;
  });
  EXPECT_GT(kept, masks.bits.size() / 2) << "a dent is local";
  EXPECT_LT(kept, masks.bits.size());
}

TEST(RefitMasksAlone,
     given_masks_that_are_compressed_or_do_not_belong_to_the_tree_then_an_error_and_masks_as_they_were) {
  const scene::Mesh mesh = scene::load("gen:tetra?depth=4").mesh;
  accel::Bvh4 tree = accel::build(mesh, {}), other = accel::build(scene::load("gen:tetra?depth=3").mesh, {});
  const ObjectMasks masks = build_object_masks(tree, {}, 1);
  const accel::RefitChanges changes = accel::refit(tree, test::moved(mesh, Motion::Twist, 1), 1);
  const auto expect_error = [&](ObjectMasks given, const accel::Bvh4& bvh, const accel::RefitChanges& what,
                                const MaskOptions& options) {
    const std::vector<std::uint64_t> before = given.bits;
    EXPECT_THROW(refit_object_masks(given, bvh, what, options, 1), Error);
    EXPECT_EQ(given.bits, before);
  };
  ObjectMasks compressed = masks;
  compressed.index.resize(masks.bits.size());
  expect_error(compressed, tree, changes, {});
  expect_error(masks, tree, changes, {.resolution = 3});
  expect_error(masks, tree, changes, {.resolution = 9});
  expect_error(masks, other, changes, {});
  expect_error(masks, tree, accel::RefitChanges(other.nodes.size()), {});
}

}  // namespace
}  // namespace ctu::cull
