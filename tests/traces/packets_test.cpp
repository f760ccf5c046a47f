// Traces whose rays travel in packets: what is written is what the reference walks, ranges that cut packets are walked
// again, and walks that are none are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>

#include "model/accel/image.h"
#include "model/base/error.h"
#include "model/cull/mask_test.h"
#include "model/reference/packet_walk.h"
#include "tests/traces/test_support.h"
#include "traces/mask_set.h"
#include "traces/slice.h"
#include "traces/trace_feed.h"
#include "traces/validate_block.h"

namespace ctu::traces {
namespace {

using cull::Design;
using test::TemporaryFolder;

RecordOptions packet_options() {
  RecordOptions options = test::small_options();
  options.rays_per_block = 500;
  options.packets = {.plan = {.size = 8, .most_entries = 3}, .forming = reference::Forming::Origin, .window = 64};
  return options;
}

class PacketTrace : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    summary_ = new RecordSummary(record(test::hair_scene(), packet_options(), path()));
  }
  static void TearDownTestSuite() {
    delete summary_;
    delete folder_;
  }
  static std::string path() { return folder_->file("packets.ctut"); }
  static TemporaryFolder* folder_;
  static RecordSummary* summary_;
};
TemporaryFolder* PacketTrace::folder_ = nullptr;
RecordSummary* PacketTrace::summary_ = nullptr;

bool same_blocks(const reference::RayBlock& a, const reference::RayBlock& b) {
  return a.first_ray == b.first_ray && test::same_rays(a.rays, b.rays) && test::same_hits(a.expected, b.expected) &&
         test::same_steps(a.steps, b.steps) && a.steps.spared == b.steps.spared && a.packets == b.packets;
}

TEST_F(PacketTrace, packets_and_steps_read_are_those_of_the_reference_and_no_hit_is_another_one) {
  const TraceReader reader(path());
  EXPECT_EQ(reader.hash(), summary_->hash);
  EXPECT_NO_THROW(reader.verify());
  EXPECT_EQ(reader.manifest().packets.plan, packet_options().packets.plan);
  EXPECT_EQ(reader.manifest().packets.forming, reference::Forming::Origin);
  EXPECT_EQ(reader.manifest().packets.window, 64);
  const accel::Image image = reader.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const MaskSet set{masks_of(image, reader.manifest().masks), nullptr};
  std::uint64_t packets = 0, spared = 0;
  for (const Design design : {Design::None, Design::MaskLut, Design::Comparators}) {
    SCOPED_TRACE(cull::to_string(design));
    const cull::MaskTester tester(design, reader.manifest().masks);
    const reference::Traversal traversal(bvh, &set.masks, tester);
    for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
      const reference::RayBlock block = reader.read_block(b, design);
      const reference::PacketWalk walk(bvh, {8, 3}, block.rays,
                                       reference::cut_packets(static_cast<std::uint32_t>(block.rays.size()), 8));
      reference::StepList steps;
      const std::vector<intersect::Hit> hits = walk.trace(traversal, steps);
      EXPECT_TRUE(block.packets == walk.list());
      EXPECT_TRUE(test::same_steps(block.steps, steps));
      EXPECT_EQ(block.steps.spared, steps.spared);
      EXPECT_TRUE(test::same_hits(block.expected, hits));
      EXPECT_NO_THROW(validate_block(block, bvh, reader.manifest().masks, path(), {8, 3}));
      if (design != Design::None) continue;
      packets += block.packets.packets();
      spared = std::accumulate(steps.spared.begin(), steps.spared.end(), spared);
    }
    EXPECT_EQ(reader.manifest().find(design)->different_hits, 0u);
  }
  EXPECT_EQ(packets, summary_->packets);
  EXPECT_GT(summary_->packet_visits, packets);
  EXPECT_GT(spared, 0u);
}

TEST_F(PacketTrace, the_rays_are_those_of_the_trace_without_packets_in_another_order_within_a_window) {
  RecordOptions options = packet_options();
  options.packets = {};
  const std::string alone = folder_->file("alone.ctut");
  record(test::hair_scene(), options, alone);
  const TraceReader with(path()), without(alone);
  EXPECT_NE(with.hash(), without.hash());
  ASSERT_EQ(with.rays(), without.rays());
  const auto less = [](const intersect::Ray& a, const intersect::Ray& b) {
    return std::memcmp(&a, &b, offsetof(intersect::Ray, kind)) < 0;
  };
  for (std::uint64_t b = 0; b < with.blocks(); ++b) {
    std::vector<intersect::Ray> left = with.read_block(b).rays, right = without.read_block(b).rays;
    for (std::size_t first = 0; first < left.size(); first += 64) {
      const auto range = [&](std::vector<intersect::Ray>& rays) {
        const auto begin = rays.begin() + static_cast<std::ptrdiff_t>(first);
        return std::pair(begin, rays.begin() + static_cast<std::ptrdiff_t>(std::min(first + 64, rays.size())));
      };
      std::sort(range(left).first, range(left).second, less);
      std::sort(range(right).first, range(right).second, less);
    }
    EXPECT_TRUE(test::same_rays(left, right)) << "block " << b;
  }
}

TEST_F(PacketTrace, the_file_is_the_same_for_any_number_of_threads) {
  RecordOptions options = packet_options();
  options.threads = 3;
  const std::string other = folder_->file("threads.ctut");
  record(test::hair_scene(), options, other);
  EXPECT_EQ(test::read_bytes(other), test::read_bytes(path()));
}

TEST_F(PacketTrace, a_trace_of_rays_that_travel_alone_says_nothing_of_packets) {
  const std::string alone = folder_->file("alone.ctut");
  record(test::hair_scene(), test::small_options(), alone);
  const TraceReader reader(alone);
  for (const Section& section : reader.manifest().sections) EXPECT_NE(section.name, "packets");
  EXPECT_EQ(to_json(reader.manifest()).find("packets"), std::string::npos);
  EXPECT_EQ(reader.read_block(0).packets.packets(), 0u);
}

TEST_F(PacketTrace, a_range_that_cuts_packets_is_fed_as_if_these_were_smaller) {
  const TraceReader reader(path());
  const accel::Image image = reader.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const MaskSet set{masks_of(image, reader.manifest().masks), nullptr};
  const cull::MaskTester tester(Design::Comparators, reader.manifest().masks);
  const reference::Traversal traversal(bvh, &set.masks, tester);
  int cut = 0, whole = 0;
  for (const RayRange range : {RayRange{0, 40}, {3, 40}, {0, 37}, {5, 6}, {16, 24}, {90, 230}, {100, 333}}) {
    TraceFeed feed(reader, range, bvh, &set.masks, tester);
    EXPECT_EQ(feed.packets(), (reference::PacketPlan{8, 3}));
    EXPECT_FALSE(feed.derives());
    while (const auto block = feed.next()) {
      const std::uint64_t number = reader.block_of(block->first_ray), start = reader.first_ray(number);
      const reference::RayBlock all = reader.read_block(number, Design::Comparators);
      for (std::size_t i = 0; i + 1 < block->packets.first_ray.size(); ++i) {
        const std::uint64_t in_block = block->first_ray - start + block->packets.first_ray[i];
        EXPECT_TRUE(i == 0 || in_block % 8 == 0);
      }
      reference::StepList steps;
      const reference::PacketWalk walk(bvh, {8, 3}, block->rays, block->packets);
      walk.trace(traversal, steps);
      EXPECT_TRUE(walk.list() == block->packets);
      EXPECT_TRUE(test::same_steps(steps, block->steps));
      EXPECT_EQ(steps.spared, block->steps.spared);
      const bool cuts =
          (block->first_ray - start) % 8 != 0 ||
          (block->rays.size() % 8 != 0 && block->first_ray + block->rays.size() != start + all.rays.size());
      ++(cuts ? cut : whole);
    }
  }
  EXPECT_GT(cut, 3);
  EXPECT_GT(whole, 2);
}

TEST_F(PacketTrace, steps_of_a_design_that_is_not_stored_are_walked_from_the_same_entries) {
  const TraceReader reader(path());
  const accel::Image image = reader.read_image();
  const accel::Bvh4 bvh = accel::decode(image);
  const MaskSet set{masks_of(image, reader.manifest().masks), nullptr};
  cull::MaskOptions finer = reader.manifest().masks;
  finer.ray_resolution = 8;
  const cull::MaskTester tester(Design::Projection, finer);
  TraceFeed feed(reader, {}, bvh, &set.masks, tester);
  EXPECT_TRUE(feed.derives());
  const auto block = feed.next();
  EXPECT_TRUE(block->packets == reader.read_block(0).packets);
  EXPECT_EQ(block->steps.rays(), block->rays.size());
}

TEST_F(PacketTrace, a_slice_at_packets_borders_keeps_them_and_another_one_is_refused) {
  const TraceReader reader(path());
  const std::uint64_t block = reader.first_ray(1);
  const std::string cut = folder_->file("cut.ctut");
  slice(path(), cut, {16, block + 24});
  const TraceReader part(cut);
  ASSERT_EQ(part.rays(), block + 8);
  const reference::RayBlock first = part.read_block(0, Design::MaskLut);
  EXPECT_TRUE(same_blocks(first, [&] {
    reference::RayBlock whole = part_of(reader.read_block(0, Design::MaskLut), 16, block);
    whole.first_ray = 0;
    return whole;
  }()));
  EXPECT_NO_THROW(test::read_all(cut));
  for (const RayRange range : {RayRange{15, 24}, {16, 25}}) try {
      slice(path(), folder_->file("refused.ctut"), range);
      FAIL() << range.first;
    } catch (const Error& error) {
      EXPECT_NE(error.problem().find("cut a packet in two"), std::string::npos) << error.what();
    }
}

TEST_F(PacketTrace, a_changed_byte_is_refused_or_changes_nothing) {
  const std::uint64_t seed = test::test_seed(53);
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  const test::Content content = test::read_all(path());
  const std::vector<std::uint8_t> whole = test::read_bytes(path());
  const std::string bad = folder_->file("bad.ctut");
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint8_t> bytes = whole;
    bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
    test::write_bytes(bad, bytes);
    try {
      EXPECT_TRUE(test::same(test::read_all(bad), content));
    } catch (const Error& problem) {
      EXPECT_EQ(problem.where(), bad);
    }
  }
}

TEST_F(PacketTrace, walks_of_packets_that_are_none_are_refused_and_the_rest_can_be_followed) {
  const std::uint64_t seed = test::test_seed(54);
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  const TraceReader reader(path());
  const accel::Bvh4 bvh = accel::decode(reader.read_image());
  const reference::RayBlock block = reader.read_block(0, Design::None);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    reference::RayBlock changed = block;
    reference::PacketList& list = changed.packets;
    const int what = i % 5;
    if (what == 0) list.visits[random() % list.visits.size()].node ^= 1u << (random() % 32);
    if (what == 1) list.visits[random() % list.visits.size()].lanes ^= static_cast<std::uint8_t>(1 + random() % 255);
    if (what == 2) list.entries[random() % list.entries.size()] ^= 1u << (random() % 32);
    if (what == 3) ++list.first_visit[1 + random() % (list.packets() - 1)];
    if (what == 4) --list.first_entry[1 + random() % (list.packets() - 1)];
    if (std::any_of(list.first_entry.begin(), list.first_entry.end(),
                    [&](auto e) { return e > list.entries.size(); }) ||
        !std::is_sorted(list.first_entry.begin(), list.first_entry.end()) ||
        !std::is_sorted(list.first_visit.begin(), list.first_visit.end()))
      continue;  // no file gives that: these are sums
    bool passed = true;
    try {
      validate_block(changed, bvh, reader.manifest().masks, path(), {8, 3});
    } catch (const Error&) {
      passed = false;
      ++refused;
    }
    EXPECT_FALSE(passed && what != 1) << "change " << i << " of kind " << what;
  }
  EXPECT_GT(refused, 2000);
}

TEST(PacketRecord, any_hit_rays_are_expected_to_find_what_they_come_to_first_from_their_packets_entries) {
  const TemporaryFolder folder;
  RecordOptions options = packet_options();
  options.rays.kind = RayOptions::Rays::Shadow;
  options.rays.width = options.rays.height = 64;
  options.packets.forming = reference::Forming::Order;
  options.packets.plan = {8, 16};
  const RecordSummary summary = record(test::hair_scene(), options, folder.file("shadow.ctut"));
  for (const DesignCounts& design : summary.designs) EXPECT_EQ(design.different_hits, 0u);
  const TraceReader reader(folder.file("shadow.ctut"));
  const accel::Bvh4 bvh = accel::decode(reader.read_image());
  const cull::MaskTester none(Design::None, {});
  const reference::Traversal alone(bvh, nullptr, none);
  std::uint64_t others = 0, any_hits = 0;
  for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
    const reference::RayBlock block = reader.read_block(b);
    for (std::size_t i = 0; i < block.rays.size(); ++i) {
      const intersect::Hit hit = alone.trace(block.rays[i]);
      EXPECT_EQ(hit.primitive == intersect::kNoPrimitive, block.expected[i].primitive == intersect::kNoPrimitive);
      any_hits += block.rays[i].kind == intersect::RayKind::AnyHit;
      others += !intersect::same_bits(hit, block.expected[i]);
    }
  }
  EXPECT_GT(any_hits, 100u);
  EXPECT_LT(others, any_hits);
  EXPECT_NO_THROW(TraceFeed(reader, {0, 16}).next());
  TraceFeed cut(reader, {1, reader.rays()});
  EXPECT_THROW(cut.next(), Error);
}

TEST(PacketRecord, options_out_of_range_are_refused) {
  const TemporaryFolder folder;
  for (const RayPackets packets : {RayPackets{.plan = {3, 4}},
                                   {.plan = {65, 4}},
                                   {.plan = {8, 0}},
                                   {.plan = {8, 17}},
                                   {.plan = {32, 4}, .window = 31}}) {
    RecordOptions options = test::small_options();
    options.packets = packets;
    EXPECT_THROW(record(test::hair_scene(), options, folder.file("x.ctut")), Error);
  }
}

}  // namespace
}  // namespace ctu::traces
