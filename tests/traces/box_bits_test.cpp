// Traces of boxes of reduced precision: what is recorded is read again, the traces of binary32 boxes stay what they
// were, and no frame or number of bits that means nothing gets past the reader.
#include <gtest/gtest.h>

#include <functional>

#include "model/accel/quantize.h"
#include "model/base/error.h"
#include "model/reference/traversal.h"
#include "tests/traces/parts.h"
#include "tests/traces/test_support.h"
#include "traces/mask_set.h"
#include "traces/slice.h"

namespace ctu::traces {
namespace {

using cull::Design;
using test::Parts;
using test::TemporaryFolder;

constexpr std::uint32_t kBits[] = {16, 12, 8};

RecordOptions options_of(std::uint32_t bits, int entries = 0) {
  RecordOptions options = test::small_options();
  options.layout.box_bits = bits;
  options.masks.entries = entries;
  options.strip_full = entries != 0;
  return options;
}

TEST(BoxBits, given_a_recording_when_read_then_the_image_has_compact_nodes_and_every_design_walks_it_as_recorded) {
  const TemporaryFolder folder;
  const scene::Scene scene = test::hair_scene();
  const RecordSummary plain = record(scene, options_of(32), folder.file("plain.ctut"));
  const TraceReader plain_reader(folder.file("plain.ctut"));
  for (const std::uint32_t bits : kBits)
    for (const int entries : {0, 16}) {
      SCOPED_TRACE(std::to_string(bits) + " bits, " + std::to_string(entries) + " entries");
      const RecordOptions options = options_of(bits, entries);
      const RecordSummary summary = record(scene, options, folder.file("b.ctut"));
      const TraceReader reader(folder.file("b.ctut"));
      EXPECT_NE(summary.hash, plain.hash);
      EXPECT_EQ(reader.hash(), summary.hash);
      const accel::Image image = reader.read_image();
      EXPECT_EQ(image.layout.box_bits, bits);
      EXPECT_EQ(image.node_stride_bytes, 32 + 3 * bits + (entries == 0 ? 32 : 4));
      if (entries != 0) {
        EXPECT_EQ(image.bare_node_stride_bytes, image.layout.bare_nodes == 0 ? 0 : 32 + 3 * bits);
      }
      EXPECT_NO_THROW(test::read_all(folder.file("b.ctut")));
      const accel::Bvh4 bvh = accel::decode(image);
      const cull::ObjectMasks masks = masks_of(image, options.masks, reader.compression().get());
      for (const Design design : {Design::None, Design::MaskLut, Design::Comparators}) {
        const cull::MaskTester tester(design, options.masks, reader.compression());
        const reference::Traversal traversal(bvh, &masks, tester);
        for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
          const reference::RayBlock block = reader.read_block(b, design);
          reference::StepList walked;
          for (std::size_t i = 0; i < block.rays.size(); ++i)
            EXPECT_TRUE(intersect::same_bits(traversal.trace(block.rays[i], &walked), block.expected[i]));
          EXPECT_TRUE(test::same_steps(block.steps, walked));
          EXPECT_TRUE(test::same_hits(block.expected, plain_reader.read_block(b, design).expected));
        }
      }
      for (const DesignCounts& design : summary.designs) EXPECT_EQ(design.different_hits, 0u);
    }
}

TEST(BoxBits, given_a_slice_when_read_then_it_has_the_same_image) {
  const TemporaryFolder folder;
  record(test::hair_scene(), options_of(12), folder.file("b.ctut"));
  slice(folder.file("b.ctut"), folder.file("s.ctut"), {20, 180});
  EXPECT_EQ(TraceReader(folder.file("s.ctut")).read_image().bytes,
            TraceReader(folder.file("b.ctut")).read_image().bytes);
  EXPECT_NO_THROW(test::read_all(folder.file("s.ctut")));
}

TEST(BoxBits, given_binary32_boxes_then_the_manifest_says_nothing_of_bits) {
  const TemporaryFolder folder;
  record(test::hair_scene(), options_of(32), folder.file("p.ctut"));
  EXPECT_EQ(Parts(folder.file("p.ctut")).manifest.find("box_bits"), std::string::npos);
}

TEST(BoxBits, given_bits_that_are_none_when_recorded_then_refused) {
  const TemporaryFolder folder;
  for (const std::uint32_t bits : {0u, 4u, 10u, 24u, 33u})
    EXPECT_THROW(record(test::hair_scene(), options_of(bits), folder.file("p.ctut")), Error) << bits;
}

class HostileBoxBits : public testing::Test {
 protected:
  void SetUp() override { record(test::hair_scene(), options_of(8), folder_.file("good.ctut")); }

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
  void with_word(const std::string& names, std::size_t word, std::uint32_t value) {
    expect_refusal(names, [&](Parts& parts) {
      Parts::Chunk& chunk = parts.chunk_of(0, 0);
      auto words = Parts::elements<std::uint32_t>(chunk);
      words[word] = value;
      Parts::set_elements(chunk, words);
    });
  }

  TemporaryFolder folder_;
};

TEST_F(HostileBoxBits, given_a_manifest_with_other_bits_then_it_is_refused) {
  expect_refusal("box_bits is 10", [](Parts& p) { p.replace("\"box_bits\": 8", "\"box_bits\": 10"); });
  expect_refusal("box_bits is 0", [](Parts& p) { p.replace("\"box_bits\": 8", "\"box_bits\": 0"); });
  expect_refusal("strides", [](Parts& p) { p.replace("\"box_bits\": 8", "\"box_bits\": 12"); });
  expect_refusal("strides", [](Parts& p) { p.replace("\"box_bits\": 8", "\"box_bits\": 32"); });
  expect_refusal("box_bits", [](Parts& p) { p.replace("\"box_bits\": 8", "\"box_bits\": -8"); });
  expect_refusal("box_bits", [](Parts& p) { p.replace("\"box_bits\": 8", "\"box_bits\": \"8\""); });
  expect_refusal("strides", [](Parts& p) { p.replace("\"box_bits\": 8", "\"no_bits\": 8"); });
}

TEST_F(HostileBoxBits, given_a_frame_that_is_none_then_it_is_refused_with_its_node) {
  with_word("node 0: an origin that is not finite", 0, 0x7f800000u);
  with_word("node 0: exponent 277", 3, 277);
  with_word("node 0: bits beside the exponents", 3, 1u << 30);
  with_word("node 0, lane", 8, 0xffffffffu);  // lower planes of x on top of the upper ones
}

}  // namespace
}  // namespace ctu::traces
