// What is written is what is read, by whichever way: whole blocks, ranges, slices, steps read or walked again.
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <limits>

#include "model/accel/image.h"
#include "model/base/error.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/reference/traversal.h"
#include "tests/traces/test_support.h"
#include "traces/mask_set.h"
#include "traces/slice.h"
#include "traces/trace_feed.h"
#include "traces/trace_writer.h"
#include "traces/validate_block.h"

namespace ctu::traces {
namespace {

using cull::Design;
using test::TemporaryFolder;

/// A hair scene with its tree, recorded once for all tests of this file.
class RecordedTrace : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    summary_ = new RecordSummary(record(test::hair_scene(), test::small_options(), path()));
  }
  static void TearDownTestSuite() {
    delete summary_;
    delete folder_;
  }
  static std::string path() { return folder_->file("recorded.ctut"); }
  static TemporaryFolder* folder_;
  static RecordSummary* summary_;
};
TemporaryFolder* RecordedTrace::folder_ = nullptr;
RecordSummary* RecordedTrace::summary_ = nullptr;

TEST(TraceFile, given_rays_of_every_bit_pattern_when_written_and_read_then_every_bit_is_kept) {
  const TemporaryFolder folder;
  const std::uint64_t seed = test::test_seed(11);
  SCOPED_TRACE(seed);
  std::uint64_t state = seed;
  const auto bits = [&] {
    return static_cast<std::uint32_t>((state = state * 6364136223846793005u + 1442695040888963407u) >> 32);
  };
  const auto number = [&] { return std::bit_cast<float>(bits()); };
  reference::RayBlock block;
  for (int i = 0; i < 1000; ++i) {
    block.rays.push_back({{number(), number(), number()},
                          number(),
                          {number(), number(), number()},
                          number(),
                          static_cast<intersect::RayKind>(bits() & 1u)});
    block.expected.push_back({number(), number(), number(), bits() % 2});
  }
  block.expected[5] = {std::numeric_limits<float>::infinity(), 0, 0, intersect::kNoPrimitive};
  const scene::Scene scene = test::square_scene(1);
  const accel::Bvh4 bvh = accel::build(scene.mesh, {});
  Manifest manifest;
  manifest.scene.triangles = 2;
  TraceWriter writer(folder.file("a.ctut"), manifest, accel::make_image(bvh, nullptr, 0, {}));
  writer.add(block, {});
  writer.add(block, {});
  writer.finish({}, {});

  const TraceReader reader(folder.file("a.ctut"));
  ASSERT_EQ(reader.rays(), 2000u);
  ASSERT_EQ(reader.blocks(), 2u);
  const reference::RayBlock read = reader.read_block(1);
  EXPECT_EQ(read.first_ray, 1000u);
  EXPECT_TRUE(test::same_rays(read.rays, block.rays));
  EXPECT_TRUE(test::same_hits(read.expected, block.expected));
}

TEST_F(RecordedTrace, given_a_scene_when_read_back_then_image_rays_hits_and_steps_are_those_of_the_reference) {
  const scene::Scene scene = test::hair_scene();
  const RecordOptions options = test::small_options();
  const accel::Bvh4 bvh = accel::build(scene.mesh, options.build);
  const cull::ObjectMasks masks = cull::build_object_masks(bvh, options.masks, 1);
  const TraceReader reader(path());
  EXPECT_EQ(reader.read_image().bytes, accel::make_image(bvh, masks.bits.data(), masks.words, {64, 4, 4}).bytes);
  EXPECT_EQ(masks_of(reader.read_image(), options.masks).bits, masks.bits);
  EXPECT_EQ(reader.manifest().scene.hash, scene::content_hash(scene.mesh).hex());
  EXPECT_EQ(reader.hash(), summary_->hash);
  EXPECT_EQ(reader.rays(), summary_->rays);
  EXPECT_GT(reader.blocks(), 3u);

  for (const Design design : {Design::None, Design::MaskLut, Design::Comparators}) {
    SCOPED_TRACE(cull::to_string(design));
    const cull::MaskTester tester(design, options.masks);
    const reference::Traversal traversal(bvh, &masks, tester);
    reference::Counts counts;
    for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
      const reference::RayBlock block = reader.read_block(b, design);
      reference::StepList walked;
      std::vector<intersect::Hit> hits;
      for (const intersect::Ray& ray : block.rays) hits.push_back(traversal.trace(ray, &walked));
      EXPECT_TRUE(test::same_steps(block.steps, walked));
      EXPECT_TRUE(test::same_hits(block.expected, hits));
      counts += reference::count_steps(walked, 0, walked.rays());
    }
    const DesignCounts* stored = reader.manifest().find(design);
    ASSERT_NE(stored, nullptr);
    EXPECT_EQ(stored->counts.rays, reader.rays());
    EXPECT_EQ(stored->counts.node_visits, counts.node_visits);
    EXPECT_EQ(stored->counts.triangle_tests, counts.triangle_tests);
    EXPECT_EQ(stored->counts.culled, counts.culled);
    EXPECT_EQ(stored->counts.dropped, counts.dropped);
    EXPECT_EQ(stored->different_hits, 0u);
  }
}

TEST_F(RecordedTrace, given_an_any_range_when_fed_then_the_rays_are_those_of_the_whole_trace) {
  const TraceReader reader(path());
  const accel::Bvh4 bvh = accel::decode(reader.read_image());
  const cull::ObjectMasks masks = masks_of(reader.read_image(), reader.manifest().masks);
  const cull::MaskTester tester(Design::Projection, reader.manifest().masks);
  std::vector<intersect::Ray> all;
  for (std::uint64_t b = 0; b < reader.blocks(); ++b)
    for (const intersect::Ray& ray : reader.read_block(b).rays) all.push_back(ray);
  for (const RayRange range : {RayRange{0, 1}, RayRange{99, 101}, RayRange{37, 390}, RayRange{250, UINT64_MAX}}) {
    SCOPED_TRACE(range.first);
    TraceFeed feed(reader, range, bvh, &masks, tester);
    EXPECT_FALSE(feed.derives());
    std::vector<intersect::Ray> fed;
    std::uint64_t next = range.first;
    while (const auto block = feed.next()) {
      EXPECT_EQ(block->first_ray, next);
      EXPECT_EQ(block->steps.rays(), block->rays.size());
      EXPECT_NO_THROW(validate_block(*block, bvh, tester.options(), "fed"));
      fed.insert(fed.end(), block->rays.begin(), block->rays.end());
      next += block->rays.size();
    }
    const std::uint64_t last = std::min<std::uint64_t>(range.last, all.size());
    EXPECT_EQ(feed.total_rays(), last - range.first);
    const std::vector<intersect::Ray> wanted(all.begin() + static_cast<std::ptrdiff_t>(range.first),
                                             all.begin() + static_cast<std::ptrdiff_t>(last));
    EXPECT_TRUE(test::same_rays(fed, wanted));
  }
}

TEST_F(RecordedTrace, given_steps_that_the_trace_lacks_when_fed_then_they_are_walked_again_and_are_the_same) {
  const TemporaryFolder folder;
  RecordOptions options = test::small_options();
  options.designs = {Design::None};
  record(test::hair_scene(), options, folder.file("lean.ctut"));
  const TraceReader lean(folder.file("lean.ctut")), full(path());
  const accel::Bvh4 bvh = accel::decode(lean.read_image());
  const cull::ObjectMasks masks = masks_of(lean.read_image(), options.masks);
  const cull::MaskTester tester(Design::MaskLut, options.masks);
  TraceFeed derived(lean, {}, bvh, &masks, tester), read(full, {}, bvh, &masks, tester);
  EXPECT_TRUE(derived.derives());
  EXPECT_FALSE(read.derives());
  while (const auto block = read.next()) {
    const auto other = derived.next();
    ASSERT_NE(other, nullptr);
    EXPECT_TRUE(test::same_steps(block->steps, other->steps));
  }
  EXPECT_EQ(derived.next(), nullptr);
}

TEST_F(RecordedTrace, given_another_key_resolution_when_fed_then_table_designs_derive_and_comparators_read) {
  const TraceReader reader(path());
  cull::MaskOptions finer = reader.manifest().masks;
  finer.ray_resolution = 8;
  EXPECT_FALSE(holds_steps(reader, Design::MaskLut, finer));
  EXPECT_FALSE(holds_steps(reader, Design::Projection, finer));
  EXPECT_TRUE(holds_steps(reader, Design::Comparators, finer));
  finer.resolution = 5;
  EXPECT_FALSE(holds_steps(reader, Design::Comparators, finer));
  EXPECT_TRUE(holds_steps(reader, Design::None, finer));
  EXPECT_FALSE(holds_steps(reader, Design::Ideal, reader.manifest().masks));
}

TEST_F(RecordedTrace, given_a_slice_when_read_then_it_is_that_part_of_the_trace_with_its_own_counts) {
  slice(path(), folder_->file("slice.ctut"), {130, 333});
  const TraceReader whole(path()), part(folder_->file("slice.ctut"));
  ASSERT_EQ(part.rays(), 203u);
  EXPECT_EQ(part.manifest().cut_from, whole.hash());
  EXPECT_EQ(part.manifest().cut_first, 130u);
  EXPECT_NE(part.hash(), whole.hash());
  EXPECT_EQ(part.read_image().bytes, whole.read_image().bytes);
  const accel::Bvh4 bvh = accel::decode(whole.read_image());
  const cull::MaskTester tester(Design::None, whole.manifest().masks);
  TraceFeed from_whole(whole, {130, 333}, bvh, nullptr, tester), from_part(part, {}, bvh, nullptr, tester);
  reference::Counts counts;
  while (const auto block = from_whole.next()) {
    const auto other = from_part.next();
    ASSERT_NE(other, nullptr);
    EXPECT_TRUE(test::same_rays(block->rays, other->rays));
    EXPECT_TRUE(test::same_hits(block->expected, other->expected));
    EXPECT_TRUE(test::same_steps(block->steps, other->steps));
    counts += reference::count_steps(other->steps, 0, other->steps.rays());
  }
  EXPECT_EQ(part.manifest().find(Design::None)->counts.node_visits, counts.node_visits);
}

TEST_F(RecordedTrace, given_a_range_outside_the_trace_when_asked_for_then_it_is_refused) {
  const TraceReader reader(path());
  EXPECT_THROW(TraceFeed(reader, {reader.rays() + 1, UINT64_MAX}), Error);
  EXPECT_THROW(TraceFeed(reader, {5, 4}), Error);
  EXPECT_THROW(slice(path(), folder_->file("empty.ctut"), {7, 7}), Error);
  EXPECT_FALSE(std::filesystem::exists(folder_->file("empty.ctut")));
  EXPECT_THROW(reader.read_block(reader.blocks()), Error);
  EXPECT_THROW(reader.read_block(0, Design::Ideal), Error);
}

TEST(TraceFile, given_hits_that_culling_changed_when_read_or_cut_then_they_are_still_listed_bit_for_bit) {
  const TemporaryFolder folder;
  const accel::Bvh4 bvh = accel::build(test::square_scene(1).mesh, {});
  Manifest manifest;
  manifest.scene.triangles = 2;
  TraceWriter writer(folder.file("d.ctut"), manifest, accel::make_image(bvh, nullptr, 0, {}));
  reference::RayBlock block;
  block.rays.resize(10);
  block.expected.resize(10);
  writer.add(block, {});
  const intersect::Hit hit{1.5f, -0.0f, std::bit_cast<float>(1u), 1};
  const intersect::Hit miss{std::numeric_limits<float>::infinity(), 0, 0, intersect::kNoPrimitive};
  writer.finish({{Design::MaskLut, false, {}, 2}}, {{Design::MaskLut, 3, hit, miss}, {Design::MaskLut, 8, hit, miss}});
  slice(folder.file("d.ctut"), folder.file("s.ctut"), {5, 10});

  const auto differences = TraceReader(folder.file("d.ctut")).manifest().differences;
  ASSERT_EQ(differences.size(), 2u);
  EXPECT_EQ(differences[0].ray, 3u);
  EXPECT_TRUE(same_bits(differences[0].expected, hit));
  EXPECT_TRUE(same_bits(differences[0].culled, miss));
  const auto kept = TraceReader(folder.file("s.ctut")).manifest().differences;
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].ray, 3u);
}

TEST(TraceFile, given_a_recording_that_stops_half_way_when_its_writer_is_gone_then_no_file_is_left) {
  const TemporaryFolder folder;
  {
    const accel::Bvh4 bvh = accel::build(test::square_scene(1).mesh, {});
    const TraceWriter writer(folder.file("half.ctut"), {}, accel::make_image(bvh, nullptr, 0, {}));
    EXPECT_TRUE(std::filesystem::exists(folder.file("half.ctut.part")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("half.ctut.part")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("half.ctut")));
}

TEST(TraceFile, given_a_folder_that_does_not_exist_when_recorded_then_the_error_names_the_file) {
  try {
    record(test::square_scene(1), test::small_options(), "/nowhere/at/all.ctut");
    FAIL() << "no error";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.where(), "/nowhere/at/all.ctut");
  }
}

}  // namespace
}  // namespace ctu::traces
