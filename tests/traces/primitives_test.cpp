// Traces of scenes with spheres, and of images with a box beside every primitive: what is recorded is read again, other
// traces stay what they were, and nothing that means nothing gets past the reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "model/base/error.h"
#include "model/reference/traversal.h"
#include "tests/traces/parts.h"
#include "tests/traces/test_support.h"
#include "traces/mask_set.h"
#include "traces/slice.h"
#include "traces/trace_feed.h"

namespace ctu::traces {
namespace {

using cull::Design;
using test::Parts;
using test::TemporaryFolder;

RecordOptions options_of(bool primitive_boxes) {
  RecordOptions options = test::small_options();
  options.layout.primitive_boxes = primitive_boxes;
  options.build.max_leaf_triangles = accel::kMaxLeafTriangles;
  options.build.triangle_cost = 0.05f;  // large leaves
  return options;
}

scene::Scene scene_with_spheres() {
  scene::Scene scene = test::hair_scene();
  const Vec3 centre = scene.mesh.vertices[scene.mesh.triangles[0][0]];
  for (int i = 0; i < 40; ++i)
    scene.mesh.spheres.push_back({{centre.x + 0.01f * static_cast<float>(i), centre.y, centre.z}, 0.02f});
  return scene;
}

/// Every stored design's steps are those that the image's tree gives when it is walked again.
void expect_walked_again(const std::string& path, const RecordOptions& options) {
  const TraceReader reader(path);
  const accel::Image image = reader.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const cull::ObjectMasks masks = masks_of(image, options.masks, reader.compression().get());
  const std::vector<accel::PrimitiveBox> boxes = reference::leaf_boxes(bvh);
  for (const Design design : {Design::None, Design::MaskLut, Design::Comparators}) {
    const cull::MaskTester tester(design, options.masks);
    const reference::Traversal traversal(bvh, &masks, tester, reader.has_primitive_boxes() ? &boxes : nullptr,
                                         cull::RayBoxRule::OncePerLeaf);
    for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
      const reference::RayBlock block = reader.read_block(b, design);
      reference::StepList walked;
      for (std::size_t i = 0; i < block.rays.size(); ++i)
        EXPECT_TRUE(intersect::same_bits(traversal.trace(block.rays[i], &walked), block.expected[i]));
      EXPECT_TRUE(test::same_steps(block.steps, walked));
    }
  }
}

TEST(PrimitiveTraces, given_spheres_or_boxes_when_read_then_every_design_walks_them_as_recorded) {
  const TemporaryFolder folder;
  for (const bool spheres : {false, true})
    for (const bool boxes : {false, true}) {
      SCOPED_TRACE(std::string(spheres ? "spheres" : "triangles") + (boxes ? ", boxes" : ""));
      const RecordSummary summary =
          record(spheres ? scene_with_spheres() : test::hair_scene(), options_of(boxes), folder.file("t.ctut"));
      const TraceReader reader(folder.file("t.ctut"));
      EXPECT_EQ(reader.hash(), summary.hash);
      EXPECT_EQ(reader.has_primitive_boxes(), boxes);
      EXPECT_EQ(reader.read_image().sphere_count, spheres ? 40u : 0u);
      EXPECT_EQ(reader.read_image().triangle_stride_bytes, boxes ? 64u : 40u);
      for (const DesignCounts& design : summary.designs) {
        EXPECT_EQ(design.different_hits, 0u);
        EXPECT_EQ(design.counts.boxed_out > 0, boxes);
        EXPECT_EQ(reader.manifest().find(design.design)->counts.boxed_out, design.counts.boxed_out);
      }
      EXPECT_NO_THROW(test::read_all(folder.file("t.ctut")));
      expect_walked_again(folder.file("t.ctut"), options_of(boxes));
    }
}

TEST(PrimitiveTraces, given_a_slice_or_a_part_then_what_boxes_met_goes_with_its_rays) {
  const TemporaryFolder folder;
  record(test::hair_scene(), options_of(true), folder.file("t.ctut"));
  slice(folder.file("t.ctut"), folder.file("s.ctut"), {20, 180});
  expect_walked_again(folder.file("s.ctut"), options_of(true));
}

TEST(PrimitiveTraces, given_steps_that_are_not_stored_when_fed_then_they_are_walked_with_boxes) {
  const TemporaryFolder folder;
  RecordOptions options = options_of(true);
  record(test::hair_scene(), options, folder.file("all.ctut"));
  options.designs = {Design::None};
  record(test::hair_scene(), options, folder.file("none.ctut"));
  const TraceReader all(folder.file("all.ctut")), none(folder.file("none.ctut"));
  const accel::Image image = all.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const cull::ObjectMasks masks = masks_of(image, options.masks, nullptr);
  const cull::MaskTester tester(Design::Comparators, options.masks);
  TraceFeed read(all, {}, bvh, &masks, tester), walked(none, {}, bvh, &masks, tester);
  EXPECT_FALSE(read.derives());
  EXPECT_TRUE(walked.derives());
  while (const auto block = read.next()) EXPECT_TRUE(test::same_steps(block->steps, walked.next()->steps));
}

TEST(PrimitiveTraces, given_triangles_without_boxes_then_the_manifest_says_nothing_of_either) {
  const TemporaryFolder folder;
  record(test::hair_scene(), options_of(false), folder.file("p.ctut"));
  const std::string manifest = Parts(folder.file("p.ctut")).manifest;
  for (const char* word : {"primitive_boxes", "sphere", "boxed_out", "\"met\""})
    EXPECT_EQ(manifest.find(word), std::string::npos) << word;
}

class HostilePrimitives : public testing::Test {
 protected:
  void SetUp() override { record(scene_with_spheres(), options_of(true), folder_.file("good.ctut")); }

  void expect_refusal(const std::string& names, const std::function<void(Parts&)>& change) {
    Parts parts(folder_.file("good.ctut"));
    change(parts);
    parts.write(folder_.file("bad.ctut"));
    try {
      test::read_all(folder_.file("bad.ctut"));
      FAIL() << names << ": was read";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(names), std::string::npos) << error.what();
    }
  }
  /// One word of the first primitive of a kind.
  void with_word(const std::string& names, bool sphere, std::size_t word, std::uint32_t value) {
    const accel::Image image = TraceReader(folder_.file("good.ctut")).read_image();
    std::uint32_t t = 0;
    while (accel::read_triangle(image, t).is_sphere() != sphere) ++t;
    expect_refusal(names, [&](Parts& parts) {
      Parts::Chunk& chunk = parts.chunk_of(0, 0);
      auto words = Parts::elements<std::uint32_t>(chunk);
      words[image.triangle_address(t) / 4 + word] = value;
      Parts::set_elements(chunk, words);
    });
  }

  TemporaryFolder folder_;
};

constexpr std::uint32_t kOne = 0x3f800000, kMinusOne = 0xbf800000, kInfinity = 0x7f800000;

TEST_F(HostilePrimitives, given_a_sphere_of_no_size_then_refused) {
  with_word("a sphere without a size", true, 3, kMinusOne);
  with_word("not finite", true, 3, kInfinity);
  with_word("not finite", true, 0, 0x7fc00000);
}
TEST_F(HostilePrimitives, given_a_box_that_is_not_the_primitives_then_refused) {
  with_word("a box that is not the primitive's", false, 10, kOne);
  with_word("a box that is not the primitive's", true, 15, kMinusOne);
}
TEST_F(HostilePrimitives, given_met_boxes_that_no_leaf_has_or_not_as_many_as_were_tested_then_refused) {
  const auto with_met = [&](const std::string& names, std::uint16_t first) {
    expect_refusal(names, [&](Parts& parts) {
      constexpr int kStepsOfNone = 3, kMet = 6;
      const auto chunk = std::find_if(parts.chunks.begin(), parts.chunks.end(), [](const Parts::Chunk& one) {
        return one.entry.section == kStepsOfNone && one.entry.column == kMet && one.entry.elements > 0;
      });
      ASSERT_NE(chunk, parts.chunks.end());
      auto met = Parts::elements<std::uint16_t>(*chunk);
      met[0] = first;
      Parts::set_elements(*chunk, met);
    });
  };
  with_met("a box is met of a primitive that the leaf does not have", 0x8000);
  with_met("not all triangles of a leaf are tested", 0);
}
TEST_F(HostilePrimitives, given_another_number_of_spheres_then_refused) {
  expect_refusal("sphere_count", [](Parts& parts) { parts.replace("\"sphere_count\": 40", "\"sphere_count\": 41"); });
  expect_refusal("strides",
                 [](Parts& parts) { parts.replace("\"primitive_boxes\": true", "\"primitive_boxes\": false"); });
}

}  // namespace
}  // namespace ctu::traces
