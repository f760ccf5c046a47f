// A recording is decided by scene and options; threads, block sizes and what else is counted change nothing in it.
#include "traces/recorder.h"

#include <gtest/gtest.h>

#include "model/base/error.h"
#include "tests/traces/test_support.h"

namespace ctu::traces {
namespace {

using cull::Design;
using test::TemporaryFolder;

TEST(Recorder, given_any_number_of_threads_then_the_file_is_the_same_byte_for_byte) {
  const TemporaryFolder folder;
  const scene::Scene scene = test::hair_scene();
  RecordOptions options = test::small_options();
  options.rays.samples_per_pixel = 4;
  record(scene, options, folder.file("1.ctut"));
  for (const int threads : {2, 5}) {
    options.threads = options.build.threads = threads;
    record(scene, options, folder.file("n.ctut"));
    EXPECT_EQ(test::read_bytes(folder.file("n.ctut")), test::read_bytes(folder.file("1.ctut")))
        << threads << " threads";
  }
}

TEST(Recorder, given_other_block_sizes_then_the_rays_and_what_they_find_are_the_same) {
  const TemporaryFolder folder;
  const scene::Scene scene = test::hair_scene();
  RecordOptions options = test::small_options();
  const auto rays_with_blocks_of = [&](std::uint32_t rays) {
    options.rays_per_block = rays;
    record(scene, options, folder.file("b.ctut"));
    const TraceReader reader(folder.file("b.ctut"));
    reference::RayBlock all;
    for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
      const reference::RayBlock block = reader.read_block(b);
      EXPECT_LE(block.rays.size(), std::max(rays, 4u));  // a path of four rays is not cut
      all.rays.insert(all.rays.end(), block.rays.begin(), block.rays.end());
      all.expected.insert(all.expected.end(), block.expected.begin(), block.expected.end());
    }
    return all;
  };
  const reference::RayBlock one = rays_with_blocks_of(1u << 20);
  EXPECT_GT(one.rays.size(), 384u);
  for (const std::uint32_t rays : {1u, 7u, 64u}) {
    const reference::RayBlock other = rays_with_blocks_of(rays);
    EXPECT_TRUE(test::same_rays(one.rays, other.rays));
    EXPECT_TRUE(test::same_hits(one.expected, other.expected));
  }
}

TEST(Recorder, given_designs_that_are_only_counted_then_they_are_in_the_summary_and_not_in_the_file) {
  const TemporaryFolder folder;
  RecordOptions options = test::small_options();
  options.designs = {Design::Projection, Design::None, Design::MaskLut};
  options.count_only = {Design::Ideal, Design::Comparators, Design::None};
  const RecordSummary summary = record(test::hair_scene(), options, folder.file("c.ctut"));
  const TraceReader reader(folder.file("c.ctut"));
  EXPECT_EQ(summary.hash, reader.hash());
  EXPECT_EQ(summary.file_bytes, reader.size_bytes());
  EXPECT_TRUE(reader.has_steps(Design::MaskLut));
  EXPECT_TRUE(reader.has_steps(Design::Projection));
  EXPECT_TRUE(reader.has_steps(Design::None));
  EXPECT_FALSE(reader.has_steps(Design::Ideal));
  EXPECT_FALSE(reader.has_steps(Design::Comparators));
  ASSERT_EQ(summary.designs.size(), 4u);
  const Manifest& manifest = reader.manifest();
  const auto visits = [&](Design design) { return manifest.find(design)->counts.node_visits; };
  EXPECT_LE(visits(Design::Ideal), visits(Design::MaskLut));
  EXPECT_LT(visits(Design::MaskLut), visits(Design::None));
  EXPECT_LT(visits(Design::Comparators), visits(Design::None));
  EXPECT_EQ(manifest.find(Design::None)->counts.culled, 0u);
}

TEST(Recorder, culling_changes_no_hit_of_any_kind_of_rays) {
  const TemporaryFolder folder;
  for (const auto kind : {RayOptions::Rays::Primary, RayOptions::Rays::Diffuse, RayOptions::Rays::Shadow,
                          RayOptions::Rays::Ao, RayOptions::Rays::Random}) {
    RecordOptions options = test::small_options();
    options.rays.kind = kind;
    options.rays.seed = test::test_seed(21);
    SCOPED_TRACE(options.rays.seed);
    options.count_only = {Design::Ideal};
    const RecordSummary summary = record(test::hair_scene(), options, folder.file("k.ctut"));
    EXPECT_GT(summary.rays, 0u);
    for (const DesignCounts& design : summary.designs) {
      EXPECT_EQ(design.different_hits, 0u) << cull::to_string(design.design) << ", " << to_string(kind);
      EXPECT_EQ(design.counts.rays, summary.rays);
    }
    EXPECT_TRUE(summary.differences.empty());
  }
}

TEST(Recorder, given_a_recording_then_the_manifest_says_how_to_make_it_again) {
  const TemporaryFolder folder;
  RecordOptions options = test::small_options();
  options.rays.kind = RayOptions::Rays::Shadow;
  options.rays.light = Vec3{0.1f, 1e30f, -3};
  options.rays.seed = UINT64_MAX;
  options.rays.tiled = true;
  options.masks = {3, 5, 2};
  options.build.max_leaf_triangles = 7;
  options.strand_thickness = 0.125f;
  scene::Scene scene = test::hair_scene();
  scene.report.warnings = {"a \"quoted\" warning\nof two lines", "caf\xc3\xa9 \xff"};
  record(scene, options, folder.file("m.ctut"));
  const TraceReader reader(folder.file("m.ctut"));
  const Manifest& manifest = reader.manifest();
  EXPECT_EQ(manifest.rays, options.rays);
  EXPECT_EQ(manifest.masks, options.masks);
  EXPECT_EQ(manifest.build.max_leaf_triangles, 7);
  EXPECT_EQ(manifest.scene.strand_thickness, 0.125f);
  EXPECT_EQ(manifest.scene.name, scene.name);
  EXPECT_EQ(manifest.scene.camera.eye, scene.camera.eye);
  EXPECT_EQ(manifest.scene.report.warnings.size(), 2u);
  EXPECT_EQ(manifest.scene.report.warnings[0], scene.report.warnings[0]);
  EXPECT_EQ(manifest.scene.triangles, scene.mesh.triangles.size());
}

TEST(Recorder, given_progress_then_it_grows_to_the_whole) {
  const TemporaryFolder folder;
  RecordOptions options = test::small_options();
  options.threads = 3;
  std::uint64_t before = 0, whole = 0;
  record(test::hair_scene(), options, folder.file("p.ctut"), [&](std::uint64_t done, std::uint64_t total) {
    EXPECT_GT(done, before);
    before = done;
    whole = total;
  });
  EXPECT_EQ(before, whole);
  EXPECT_EQ(whole, 24u * 16u);
}

TEST(Recorder, given_a_block_size_out_of_range_then_it_is_refused) {
  const TemporaryFolder folder;
  RecordOptions options = test::small_options();
  for (const std::uint32_t rays : {0u, kMaxRaysPerBlock + 1}) {
    options.rays_per_block = rays;
    EXPECT_THROW(record(test::square_scene(1), options, folder.file("r.ctut")), Error);
  }
}

}  // namespace
}  // namespace ctu::traces
