// The committed trace: what earlier versions wrote is read, and what they found is found again. When a change is meant
// to alter it, docs/trace-format.md has the command that makes the file anew.
#include <gtest/gtest.h>

#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/traces/test_support.h"
#include "traces/mask_set.h"

namespace ctu::traces {
namespace {

using cull::Design;

constexpr const char* kPath = CTU_TEST_DATA "/hair-ball.ctut";
constexpr const char* kHash = "f78dc0a272d15a1e646e2b9e2739bdc0";

struct Golden {
  Design design;
  std::uint64_t node_visits, triangle_tests, box_hits, culled, dropped;
};
constexpr Golden kGolden[] = {
    {Design::None, 13279, 3036, 13427, 0, 654},
    {Design::MaskLut, 11221, 2180, 13123, 2440, 564},
    {Design::Comparators, 10896, 1977, 12968, 2768, 547},
};

TEST(CommittedTrace, it_is_read_as_it_was_written) {
  const TraceReader reader(kPath);
  EXPECT_EQ(reader.hash(), kHash);
  EXPECT_EQ(reader.rays(), 2578u);
  EXPECT_NO_THROW(reader.verify());
  EXPECT_NO_THROW(test::read_all(kPath));
  for (const Golden& golden : kGolden) {
    SCOPED_TRACE(cull::to_string(golden.design));
    reference::Counts counts;
    for (std::uint64_t block = 0; block < reader.blocks(); ++block) {
      const reference::StepList steps = reader.read_block(block, golden.design).steps;
      counts += reference::count_steps(steps, 0, steps.rays());
    }
    EXPECT_EQ(counts.node_visits, golden.node_visits);
    EXPECT_EQ(counts.triangle_tests, golden.triangle_tests);
    EXPECT_EQ(counts.box_hits, golden.box_hits);
    EXPECT_EQ(counts.culled, golden.culled);
    EXPECT_EQ(counts.dropped, golden.dropped);
  }
}

/// Recorded before scenes could have spheres: image, rays, hits and steps without any are the same bytes.
TEST(CommittedTrace, a_scene_without_spheres_has_the_trace_it_had_before_there_were_any) {
  const test::TemporaryFolder folder;
  for (const auto& [name, hash] : {std::pair{"gen:tetra?depth=4", "d7d8b37f3c96de21bbadac9d94b83820"},
                                   {"gen:hair-ball?strands=50", "93d63b5375af025d9b4708da6dc9fa0b"}}) {
    RecordOptions options;
    options.rays.kind = RayOptions::Rays::Diffuse;
    options.rays.width = 32;
    options.rays.height = 18;
    EXPECT_EQ(record(scene::load(name), options, folder.file("a.ctut")).hash, hash) << name;
  }
}

TEST(CommittedTrace, todays_reference_walks_its_rays_step_by_step_as_recorded) {
  const TraceReader reader(kPath);
  const accel::Image image = reader.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const cull::ObjectMasks masks = masks_of(image, reader.manifest().masks);
  for (const Golden& golden : kGolden) {
    SCOPED_TRACE(cull::to_string(golden.design));
    const cull::MaskTester tester(golden.design, reader.manifest().masks);
    const reference::Traversal traversal(bvh, &masks, tester);
    for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
      const reference::RayBlock block = reader.read_block(b, golden.design);
      reference::StepList walked;
      std::vector<intersect::Hit> hits;
      for (const intersect::Ray& ray : block.rays) hits.push_back(traversal.trace(ray, &walked));
      EXPECT_TRUE(test::same_steps(block.steps, walked));
      EXPECT_TRUE(test::same_hits(block.expected, hits));
    }
  }
}

TEST(CommittedTrace, todays_recorder_makes_it_again) {
  const Manifest manifest = TraceReader(kPath).manifest();
  RecordOptions options;
  options.rays = manifest.rays;
  options.build = manifest.build;
  options.masks = manifest.masks;
  const test::TemporaryFolder folder;
  EXPECT_EQ(record(scene::load(manifest.scene.name), options, folder.file("again.ctut")).hash, kHash)
      << "another scene, tree, masks, rays or walk than " << kPath << " was made with";
}

}  // namespace
}  // namespace ctu::traces
