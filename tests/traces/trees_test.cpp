// Traces whose shadow rays walk local trees: no ray's answer changes for it, the file says which tree each walks, and
// files that lie about it are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "model/base/error.h"
#include "model/reference/block_walk.h"
#include "model/scene/load.h"
#include "tests/traces/parts.h"
#include "tests/traces/test_support.h"
#include "traces/slice.h"
#include "traces/trace_feed.h"

namespace ctu::traces {
namespace {

using cull::Design;
using test::Parts;
using test::TemporaryFolder;

RecordOptions tree_options(bool with_trees = true) {
  RecordOptions options = test::small_options();
  options.rays.kind = RayOptions::Rays::Shadow;
  options.rays.width = 200, options.rays.height = 150;
  options.rays_per_block = 500;
  if (with_trees) options.trees.most_areas = 4;
  return options;
}

scene::Scene foliage() { return scene::load("gen:foliage?twigs=100"); }

class TreeTrace : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    summary_ = new RecordSummary(record(foliage(), tree_options(), path()));
    record(foliage(), tree_options(false), folder_->file("one.ctut"));
  }
  static void TearDownTestSuite() {
    delete summary_;
    delete folder_;
  }
  static std::string path() { return folder_->file("trees.ctut"); }
  static TemporaryFolder* folder_;
  static RecordSummary* summary_;
};
TemporaryFolder* TreeTrace::folder_ = nullptr;
RecordSummary* TreeTrace::summary_ = nullptr;

bool found(const intersect::Hit& hit) { return hit.primitive != intersect::kNoPrimitive; }

TEST_F(TreeTrace, rays_find_something_where_they_do_in_one_tree_and_most_walk_a_local_one) {
  const TraceReader with(path()), without(folder_->file("one.ctut"));
  ASSERT_EQ(with.rays(), without.rays());
  ASSERT_GT(with.rays(), 100u);
  EXPECT_GT(summary_->trees, 1u);
  EXPECT_GT(summary_->local_rays, with.rays() / 2);
  EXPECT_LT(summary_->own_tests, summary_->global_tests);
  for (const DesignCounts& counts : summary_->designs) EXPECT_EQ(counts.different_hits, 0u);
  std::uint64_t hits = 0, local = 0;
  for (std::uint64_t b = 0; b < with.blocks(); ++b) {
    const reference::RayBlock one = without.read_block(b), trees = with.read_block(b);
    ASSERT_TRUE(test::same_rays(one.rays, trees.rays));
    ASSERT_EQ(trees.trees.size(), trees.rays.size());
    for (std::size_t i = 0; i < one.rays.size(); ++i) {
      EXPECT_EQ(found(one.expected[i]), found(trees.expected[i])) << "ray " << one.first_ray + i;
      hits += found(one.expected[i]);
      local += trees.trees[i].tree != 0;
    }
  }
  EXPECT_EQ(local, summary_->local_rays);
  EXPECT_GT(hits, 0u);
  EXPECT_LT(hits, with.rays());
}

TEST_F(TreeTrace, steps_and_tests_read_are_those_of_the_reference_in_the_rays_tree) {
  const TraceReader reader(path());
  EXPECT_NO_THROW(reader.verify());
  EXPECT_EQ(reader.hash(), summary_->hash);
  const accel::Image image = reader.read_image();
  EXPECT_EQ(image.trees(), summary_->trees);
  const accel::Bvh4 bvh = accel::decode(image);
  const cull::ObjectMasks masks = masks_of(image, reader.manifest().masks);
  const cull::MaskTester none(Design::None, {});
  const reference::Traversal plain(bvh, nullptr, none);
  for (const Design design : {Design::None, Design::MaskLut, Design::Comparators}) {
    SCOPED_TRACE(cull::to_string(design));
    const cull::MaskTester tester(design, reader.manifest().masks);
    const reference::Traversal traversal(bvh, &masks, tester);
    for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
      const reference::RayBlock block = reader.read_block(b, design);
      reference::RayBlock walked = block;
      EXPECT_TRUE(test::same_hits(block.expected, reference::walk_block(traversal, {}, walked)));
      EXPECT_TRUE(test::same_steps(block.steps, walked.steps));
      for (std::size_t i = 0; i < block.rays.size() && design == Design::None; ++i) {
        reference::StepList own, global;
        plain.trace_in(block.trees[i].tree, block.rays[i], &own);
        plain.trace(block.rays[i], &global);
        EXPECT_EQ(block.trees[i].own_tests, reference::count_steps(own, 0, 1).intersections());
        EXPECT_EQ(block.trees[i].global_tests, reference::count_steps(global, 0, 1).intersections());
      }
    }
  }
}

TEST_F(TreeTrace, the_file_is_the_same_for_any_number_of_threads) {
  RecordOptions options = tree_options();
  options.threads = 3;
  record(foliage(), options, folder_->file("threads.ctut"));
  EXPECT_EQ(test::read_bytes(folder_->file("threads.ctut")), test::read_bytes(path()));
}

TEST_F(TreeTrace, masks_boxes_and_packets_go_with_them_and_change_no_answer) {
  RecordOptions options = tree_options();
  options.layout.primitive_boxes = true;
  options.layout.box_bits = 12;
  options.strip_full = true;
  options.packets = {.plan = {.size = 8, .most_entries = 4}, .forming = reference::Forming::Origin, .window = 64};
  const RecordSummary all = record(foliage(), options, folder_->file("all.ctut"));
  for (const DesignCounts& counts : all.designs) EXPECT_EQ(counts.different_hits, 0u);
  EXPECT_GT(all.local_rays, 0u);
  EXPECT_GT(all.packets, 0u);
  EXPECT_NO_THROW(test::read_all(folder_->file("all.ctut")));
  const TraceReader reader(folder_->file("all.ctut")), one(folder_->file("one.ctut"));
  std::uint64_t hits = 0, hits_of_one = 0;
  for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
    const reference::RayBlock block = reader.read_block(b), alone = one.read_block(b);
    for (const intersect::Hit& hit : block.expected) hits += found(hit);
    for (const intersect::Hit& hit : alone.expected) hits_of_one += found(hit);
    for (std::uint64_t p = 0; p < block.packets.packets(); ++p)
      for (auto ray = block.packets.first_ray[p]; ray < block.packets.first_ray[p + 1]; ++ray)
        EXPECT_EQ(block.trees[ray].tree, block.trees[block.packets.first_ray[p]].tree);
  }
  EXPECT_EQ(hits, hits_of_one);
}

TEST_F(TreeTrace, a_slice_and_a_range_keep_the_trees_of_their_rays) {
  slice(path(), folder_->file("slice.ctut"), {100, 900});
  const TraceReader whole(path()), part(folder_->file("slice.ctut"));
  const accel::Image image = whole.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const cull::ObjectMasks masks = masks_of(image, whole.manifest().masks);
  const cull::MaskTester tester(Design::Comparators, whole.manifest().masks);
  TraceFeed range(whole, {100, 900}, bvh, &masks, tester), sliced(part, {}, bvh, &masks, tester);
  std::vector<reference::RayTree> a, b;
  while (const auto block = range.next()) a.insert(a.end(), block->trees.begin(), block->trees.end());
  while (const auto block = sliced.next()) b.insert(b.end(), block->trees.begin(), block->trees.end());
  EXPECT_EQ(a.size(), std::min<std::uint64_t>(900, whole.rays()) - 100);
  EXPECT_TRUE(a == b);
}

TEST_F(TreeTrace, steps_that_are_not_stored_are_walked_in_the_rays_trees) {
  RecordOptions options = tree_options();
  options.designs = {Design::None};
  options.count_only = {Design::Comparators};
  record(foliage(), options, folder_->file("bare.ctut"));
  const TraceReader all(path()), bare(folder_->file("bare.ctut"));
  const accel::Image image = all.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const cull::ObjectMasks masks = masks_of(image, all.manifest().masks);
  const cull::MaskTester tester(Design::Comparators, all.manifest().masks);
  TraceFeed read(all, {}, bvh, &masks, tester), walked(bare, {}, bvh, &masks, tester);
  EXPECT_TRUE(walked.derives());
  while (const auto block = read.next()) EXPECT_TRUE(test::same_steps(block->steps, walked.next()->steps));
}

TEST_F(TreeTrace, spheres_have_local_trees_too) {
  RecordOptions options = tree_options();
  const RecordSummary summary = record(scene::load("gen:balls?depth=2"), options, folder_->file("balls.ctut"));
  EXPECT_GT(summary.local_rays, 0u);
  for (const DesignCounts& counts : summary.designs) EXPECT_EQ(counts.different_hits, 0u);
  EXPECT_NO_THROW(test::read_all(folder_->file("balls.ctut")));
}

TEST_F(TreeTrace, rays_that_run_to_no_light_get_no_tree) {
  RecordOptions options = tree_options();
  options.rays.kind = RayOptions::Rays::Primary;
  const RecordSummary summary = record(foliage(), options, folder_->file("primary.ctut"));
  EXPECT_EQ(summary.trees, 1u);
  EXPECT_EQ(summary.local_rays, 0u);
  EXPECT_NO_THROW(test::read_all(folder_->file("primary.ctut")));
}

TEST_F(TreeTrace, a_trace_of_one_tree_says_nothing_of_trees) {
  const std::string manifest = Parts(folder_->file("one.ctut")).manifest;
  for (const char* word : {"further_roots", "most_areas", "own_tests", "\"tree\""})
    EXPECT_EQ(manifest.find(word), std::string::npos) << word;
  EXPECT_TRUE(TraceReader(folder_->file("one.ctut")).read_block(0).trees.empty());
}

TEST_F(TreeTrace, options_out_of_range_are_refused) {
  for (const int most : {-1, 256, 1000}) {
    RecordOptions options = tree_options();
    options.trees.most_areas = most;
    EXPECT_THROW(record(foliage(), options, folder_->file("never.ctut")), Error) << most;
  }
}

TEST_F(TreeTrace, files_that_lie_about_trees_are_refused) {
  const auto expect_refusal = [&](const std::string& names, const std::function<void(Parts&)>& change) {
    Parts parts(path());
    change(parts);
    parts.write(folder_->file("bad.ctut"));
    try {
      test::read_all(folder_->file("bad.ctut"));
      FAIL() << names << ": was read";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(names), std::string::npos) << error.what();
    }
  };
  constexpr int kTreeColumn = 9;
  const auto with_trees = [&](const std::string& names, const std::function<void(std::vector<std::uint8_t>&)>& change) {
    expect_refusal(names, [&](Parts& parts) {
      Parts::Chunk& chunk = parts.chunk_of(1, kTreeColumn);
      auto trees = Parts::elements<std::uint8_t>(chunk);
      change(trees);
      Parts::set_elements(chunk, trees);
    });
  };
  with_trees("walks tree 200", [](auto& trees) { trees.front() = 200; });
  with_trees("not what lies on the stack", [](auto& trees) {
    for (std::uint8_t& tree : trees) tree = tree == 0 ? 1 : 0;
  });
  expect_refusal("most_areas", [](Parts& parts) { parts.replace("\"most_areas\": 4", "\"most_areas\": 256"); });
  expect_refusal("further_roots",
                 [](Parts& parts) { parts.replace("\"further_roots\": [", "\"further_roots\": [0,"); });
  expect_refusal("further_roots",
                 [](Parts& parts) { parts.replace("\"further_roots\": [", "\"further_roots\": [-1,"); });
}

}  // namespace
}  // namespace ctu::traces
