// Compressed masks in a trace: what the recorder compressed is what a reader gets, whatever R and the number of
// entries; and no index or entry that means nothing gets past the reader.
#include <gtest/gtest.h>

#include <bit>
#include <functional>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/cull/compress.h"
#include "model/cull/mask_words.h"
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

constexpr int kImageSection = 0, kCompressionSection = 6;  // image, rays, hits, three designs, compression

struct Sizes {
  int resolution, ray_resolution, entries;
};
std::string name(const testing::TestParamInfo<Sizes>& info) {
  return "R" + std::to_string(info.param.resolution) + "_" + std::to_string(info.param.ray_resolution) + "_" +
         std::to_string(info.param.entries);
}

RecordOptions options_of(const Sizes& sizes) {
  RecordOptions options = test::small_options();
  options.masks.resolution = sizes.resolution;
  options.masks.ray_resolution = sizes.ray_resolution;
  options.masks.entries = sizes.entries;
  options.masks.selection = cull::Selection::TopSummed;
  return options;
}

class CompressedTrace : public testing::TestWithParam<Sizes> {};

TEST_P(CompressedTrace, given_a_recording_when_read_then_lut_and_masks_are_those_that_were_compressed) {
  const RecordOptions options = options_of(GetParam());
  const TemporaryFolder folder;
  const scene::Scene scene = test::hair_scene();
  const RecordSummary summary = record(scene, options, folder.file("c.ctut"));
  const TraceReader reader(folder.file("c.ctut"));
  EXPECT_EQ(reader.manifest().masks, options.masks);
  EXPECT_EQ(reader.hash(), summary.hash);
  EXPECT_NO_THROW(reader.verify());

  const accel::Bvh4 bvh = accel::build(scene.mesh, options.build);
  const cull::ObjectMasks plain = cull::build_object_masks(bvh, options.masks, 1);
  const cull::CompressedMasks wanted = cull::compress(bvh, plain, options.masks, 1);
  ASSERT_NE(reader.compression(), nullptr);
  EXPECT_EQ(reader.compression()->bits(), wanted.lut.bits());
  EXPECT_EQ(summary.compression_entries, wanted.lut.entries());
  const accel::Image image = reader.read_image();
  const auto entries = static_cast<std::uint32_t>(wanted.lut.entries());
  EXPECT_EQ(image.layout.mask_bits, static_cast<std::uint32_t>(std::bit_width(entries - 1)));
  EXPECT_EQ(image.node_stride_bytes, entries <= 256 ? 116u : 120u);  // an index takes whole bytes
  const cull::ObjectMasks read = masks_of(image, options.masks, reader.compression().get());
  EXPECT_EQ(read.bits, wanted.masks.bits);
  EXPECT_EQ(read.index, wanted.masks.index);
  for (std::uint32_t node = 0; node < image.node_count; ++node)
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      ASSERT_TRUE(cull::holds_all(read.mask(node, lane), plain.mask(node, lane), plain.words)) << node << " " << lane;
}

TEST_P(CompressedTrace, given_a_recording_when_walked_again_then_the_steps_are_those_of_the_compressed_masks) {
  const RecordOptions options = options_of(GetParam());
  const TemporaryFolder folder;
  const RecordSummary summary = record(test::hair_scene(), options, folder.file("c.ctut"));
  const TraceReader reader(folder.file("c.ctut"));
  const accel::Image image = reader.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const cull::ObjectMasks masks = masks_of(image, options.masks, reader.compression().get());
  for (const Design design : {Design::MaskLut, Design::Projection, Design::Comparators}) {
    SCOPED_TRACE(cull::to_string(design));
    const cull::MaskTester tester(design, options.masks, reader.compression());
    ASSERT_TRUE(holds_steps(reader, design, tester.options()));
    const reference::Traversal traversal(bvh, &masks, tester);
    for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
      const reference::RayBlock block = reader.read_block(b, design);
      reference::StepList walked;
      std::vector<intersect::Hit> hits;
      for (const intersect::Ray& ray : block.rays) hits.push_back(traversal.trace(ray, &walked));
      EXPECT_TRUE(test::same_steps(block.steps, walked));
      EXPECT_TRUE(test::same_hits(block.expected, hits));
    }
  }
  for (const DesignCounts& design : summary.designs) EXPECT_EQ(design.different_hits, 0u);
}

TEST_P(CompressedTrace, given_a_slice_when_read_then_it_has_the_same_lut_and_image) {
  const TemporaryFolder folder;
  record(test::hair_scene(), options_of(GetParam()), folder.file("c.ctut"));
  slice(folder.file("c.ctut"), folder.file("s.ctut"), {20, 180});
  const TraceReader whole(folder.file("c.ctut")), part(folder.file("s.ctut"));
  ASSERT_NE(part.compression(), nullptr);
  EXPECT_EQ(part.compression()->bits(), whole.compression()->bits());
  EXPECT_EQ(part.read_image().bytes, whole.read_image().bytes);
  EXPECT_NO_THROW(test::read_all(folder.file("s.ctut")));
}

INSTANTIATE_TEST_SUITE_P(Sizes, CompressedTrace,
                         testing::Values(Sizes{4, 4, 16}, Sizes{4, 4, 256}, Sizes{4, 8, 4096}, Sizes{6, 6, 16},
                                         Sizes{6, 6, 256}, Sizes{6, 6, 4096}),
                         name);

TEST_P(CompressedTrace, given_bare_nodes_when_read_then_masks_hits_and_work_are_those_of_the_whole_image) {
  RecordOptions options = options_of(GetParam());
  const TemporaryFolder folder;
  const RecordSummary whole = record(test::hair_scene(), options, folder.file("w.ctut"));
  options.strip_full = true;
  const RecordSummary stripped = record(test::hair_scene(), options, folder.file("s.ctut"));
  if (options.masks.entries < 4096) EXPECT_GT(stripped.bare_nodes, 0u);  // few entries, so many masks become full
  EXPECT_EQ(stripped.image_bytes<whole.image_bytes, stripped.bare_nodes> 0);
  const TraceReader reader(folder.file("s.ctut"));
  const accel::Image image = reader.read_image();
  EXPECT_EQ(image.layout.bare_nodes, stripped.bare_nodes);
  EXPECT_NO_THROW(test::read_all(folder.file("s.ctut")));
  const cull::ObjectMasks masks = masks_of(image, options.masks, reader.compression().get());
  const auto full = cull::full_mask(options.masks.resolution);
  for (std::uint32_t node = 1; node < image.node_count; ++node) {
    const accel::Node4 lanes = accel::read_node(image, node);
    bool all_full = true;
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      all_full &=
          lanes.child[lane] == accel::kEmptyChild || std::equal(full.begin(), full.end(), masks.mask(node, lane));
    EXPECT_EQ(all_full, node >= image.masked_nodes()) << node;
  }
  for (std::size_t i = 0; i < whole.designs.size(); ++i) {
    EXPECT_EQ(stripped.designs[i].counts.node_visits, whole.designs[i].counts.node_visits);
    EXPECT_EQ(stripped.designs[i].counts.triangle_tests, whole.designs[i].counts.triangle_tests);
    EXPECT_EQ(stripped.designs[i].counts.culled, whole.designs[i].counts.culled);
    EXPECT_EQ(stripped.designs[i].different_hits, 0u);
  }
}

TEST(Compression, fewer_entries_cull_no_more) {
  const TemporaryFolder folder;
  std::uint64_t before = UINT64_MAX;
  for (const int entries : {16, 64, 4096, 0}) {
    const RecordSummary summary = record(test::hair_scene(), options_of({4, 4, entries}), folder.file("n.ctut"));
    const std::uint64_t work = summary.designs[1].counts.intersections();
    EXPECT_LE(work, before + before / 50) << entries;  // the paths differ a little where fewer boxes are culled
    before = work;
  }
}

/// A trace with entries of two words, forged with every checksum right.
class HostileCompression : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    record(test::hair_scene(), options_of({5, 5, 40}), good());
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string good() { return folder_->file("good.ctut"); }

  static void expect_refusal(const std::string& part, const std::function<void(Parts&)>& change) {
    const std::string bad = folder_->file("bad.ctut");
    Parts parts(good());
    change(parts);
    parts.write(bad);
    try {
      test::read_all(bad);
      ADD_FAILURE() << "the file was read; expected: " << part;
    } catch (const Error& problem) {
      EXPECT_EQ(problem.where(), bad);
      EXPECT_NE(problem.problem().find(part), std::string::npos) << problem.problem();
    }
  }
  template <class T>
  static void expect_refusal(const std::string& part, int section, const std::function<void(std::vector<T>&)>& change) {
    expect_refusal(part, [&](Parts& parts) {
      Parts::Chunk& chunk = parts.chunk_of(section, 0);
      auto values = Parts::elements<T>(chunk);
      change(values);
      Parts::set_elements(chunk, values);
    });
  }

  static TemporaryFolder* folder_;
};
TemporaryFolder* HostileCompression::folder_ = nullptr;

TEST_F(HostileCompression, given_entries_that_are_no_lut_then_they_are_refused) {
  using Words = std::vector<std::uint64_t>;
  const auto expect_lut_refused = [](const std::string& part, const std::function<void(Words&)>& change) {
    expect_refusal<std::uint64_t>(part, kCompressionSection, change);
  };
  expect_lut_refused("ascending", [](Words& w) { std::swap_ranges(w.begin(), w.begin() + 2, w.begin() + 2); });
  expect_lut_refused("ascending", [](Words& w) { std::copy_n(w.begin(), 2, w.begin() + 2); });
  expect_lut_refused("not the full mask", [](Words& w) { w.resize(w.size() - 2); });
  expect_lut_refused("not the full mask", [](Words& w) { w.back() &= w.back() - 1; });
  expect_lut_refused("words", [](Words& w) { w.pop_back(); });
  expect_lut_refused("words", [](Words& w) { w.clear(); });
  expect_lut_refused("words", [](Words& w) { w.insert(w.begin(), 2 * 41 - w.size(), 1); });
  expect_lut_refused("cells that R = 5 does not have", [](Words& w) { w[1] |= std::uint64_t{1} << 61; });
  // Fewer entries need fewer bits than the nodes have.
  expect_lut_refused("indices of 6 bits", [](Words& w) { w.erase(w.begin(), w.end() - 2 * 17); });
}

TEST_F(HostileCompression, given_a_column_that_lies_then_it_is_refused) {
  expect_refusal("compression: the section is missing",
                 [](Parts& p) { p.replace("\"name\": \"compression\"", "\"name\": \"decompression\""); });
  expect_refusal("compression: column entries",
                 [](Parts& p) { p.replace("\"name\": \"entries\"", "\"name\": \"exits\""); });
  expect_refusal("compression", [](Parts& p) { p.chunk_of(kCompressionSection, 0).entry.elements += 2; });
  expect_refusal("compression", [](Parts& p) { p.chunk_of(kCompressionSection, 0).entry.elements = UINT32_MAX; });
  expect_refusal("compression", [](Parts& p) { p.chunk_of(kCompressionSection, 0).frame.pop_back(); });
  expect_refusal("not one block", [](Parts& p) {
    Parts::Chunk twice = p.chunk_of(kCompressionSection, 0);
    twice.entry.block = 1;
    p.chunks.push_back(twice);
  });
  expect_refusal("not one block", [](Parts& p) {
    std::erase_if(p.chunks, [](const auto& chunk) { return chunk.entry.section == kCompressionSection; });
  });
}

TEST_F(HostileCompression, given_a_manifest_that_does_not_fit_then_it_is_refused) {
  expect_refusal("compression", [](Parts& p) { p.replace("\"entries\": 40", "\"entries\": 16"); });
  expect_refusal("masks of 6 bits", [](Parts& p) { p.replace("\"entries\": 40", "\"entries\": 0"); });
  expect_refusal("entries", [](Parts& p) { p.replace("\"entries\": 40", "\"entries\": 4097"); });
  expect_refusal("selection", [](Parts& p) { p.replace("\"top-summed\"", "\"by-colour\""); });
  expect_refusal("compression", [](Parts& p) { p.replace("\"resolution\": 5", "\"resolution\": 4"); });
}

TEST_F(HostileCompression, given_an_index_that_names_no_entry_then_it_is_refused_with_its_node_and_lane) {
  const TraceReader reader(good());
  const accel::Image image = reader.read_image();
  const auto entries = static_cast<std::uint32_t>(reader.compression()->entries());
  ASSERT_LT(entries, 64u);
  const std::uint32_t node = image.node_count / 2;
  const std::uint64_t word = (image.node_address(node) + accel::kNodeBytes) / 4;  // a byte for each lane
  for (const std::uint32_t index : {entries, 63u, 64u, 255u})
    for (const std::uint32_t lane : {0u, 3u})
      expect_refusal<std::uint32_t>("node " + std::to_string(node) + ", lane " + std::to_string(lane), kImageSection,
                                    [&](std::vector<std::uint32_t>& words) {
                                      words[word] = (words[word] & ~(255u << (8 * lane))) | index << (8 * lane);
                                    });
}

}  // namespace
}  // namespace ctu::traces
