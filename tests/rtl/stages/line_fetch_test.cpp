// rtl/node_fetch.sv and rtl/leaf_fetch.sv, and with them line_fetch, against the model's stages within a unit at work.
#include "VFetchFourPorts.h"
#include "VFetchOnePort.h"
#include "VFetchTwoPorts.h"
#include "VMutantFetchFirstInFirstOut.h"
#include "VMutantFetchHighestRegister.h"
#include "VMutantFetchReadsUncounted.h"
#include "VMutantFetchTurnStays.h"
#include "VMutantFetchTwoRequests.h"
#include "model/cull/object_masks.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/verilated_fetch.h"

namespace ctu::rtl {
namespace {

using pipeline::Activity;
using pipeline::CacheConfig;
using pipeline::MemoryModel;
using pipeline::UnitConfig;

constexpr const char* kScene = "gen:straight-hair?strands=150";
constexpr std::uint64_t kAllCells = ~std::uint64_t{0};  // the full mask at R = 4

struct Compared {
  std::string difference;
  std::uint64_t nodes = 0, leaves = 0;
  std::uint64_t cycles_of[pipeline::kActivities] = {};
};

template <class Model>
Compared compare(const test::World& world, const accel::Image& image, const UnitConfig& config, std::uint64_t full_mask,
                 std::uint64_t stall_seed) {
  Compared compared;
  VerilatedFetch<Model> twin(image, config, full_mask);
  StageRun run(world, image, config, stall_seed);
  auto& stages = run.unit().stages();
  compared.difference = run.first_difference([&] {
    ++compared.cycles_of[static_cast<int>(stages.node_fetch.account.current())];
    ++compared.cycles_of[static_cast<int>(stages.leaf_fetch.account.current())];
    return twin.cycle(stages.node_fetch, stages.leaf_fetch);
  });
  compared.nodes = twin.nodes;
  compared.leaves = twin.leaves;
  return compared;
}

/// The caches of a configuration: lines in all, ways, latency, miss registers.
struct Caches {
  int contexts;
  int node_lines, node_ways, leaf_lines, leaf_ways;
  int hit_latency, mshrs;
  MemoryModel memory;
};

std::ostream& operator<<(std::ostream& out, const Caches& caches) {
  return out << caches.contexts << " contexts, node cache " << caches.node_lines << " lines, " << caches.node_ways
             << " ways, leaf cache " << caches.leaf_lines << " lines, " << caches.leaf_ways << " ways, hit latency "
             << caches.hit_latency << ", " << caches.mshrs << " miss registers, memory "
             << static_cast<int>(caches.memory);
}

UnitConfig config_of(UnitConfig config, const Caches& caches, int line_bytes, int ports) {
  config.unit.contexts = caches.contexts;
  config.memory.model = caches.memory;
  config.memory.line_bytes = line_bytes;
  config.memory.latency = 40;
  config.memory.interval = 1;
  config.stack.spill_batch = 4;
  config.node_cache = {caches.node_lines * line_bytes, caches.node_ways, caches.hit_latency, ports, caches.mshrs};
  config.leaf_cache = {caches.leaf_lines * line_bytes, caches.leaf_ways, caches.hit_latency, ports, caches.mshrs};
  return config;
}

constexpr Caches kCaches[] = {
    {8, 64, 4, 32, 4, 3, 8, MemoryModel::Banked},   {8, 1, 1, 1, 1, 1, 1, MemoryModel::Ideal},
    {1, 16, 16, 2, 2, 20, 4, MemoryModel::Ideal},   {8, 0, 1, 0, 1, 2, 8, MemoryModel::Banked},
    {7, 8, 1, 16, 16, 7, 7, MemoryModel::Ideal},    {8, 12, 3, 3, 3, 4, 2, MemoryModel::Banked},
    {5, 256, 4, 128, 16, 1, 3, MemoryModel::Ideal},
};

/// All configurations and refusals; every stall must have occurred and every node and leaf been compared twice.
template <class Model>
void expect_twins(const test::World& world, const accel::Image& image, std::uint64_t full_mask, int line_bytes,
                  int ports) {
  SCOPED_TRACE(oracle::seed_note());
  std::uint64_t cycles_of[pipeline::kActivities] = {};
  for (const Caches& caches : kCaches) {
    for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed()}) {
      const Compared compared =
          compare<Model>(world, image, config_of(world.config(), caches, line_bytes, ports), full_mask, stall_seed);
      ASSERT_EQ(compared.difference, "") << caches << ", stall seed " << stall_seed;
      EXPECT_GT(compared.nodes, 100u);
      EXPECT_GT(compared.leaves, 50u);
      for (int i = 0; i < pipeline::kActivities; ++i) cycles_of[i] += compared.cycles_of[i];
    }
  }
  for (const Activity activity : {Activity::Busy, Activity::Idle, Activity::OutputFull, Activity::MshrsFull,
                                  Activity::MemoryPortFull, Activity::FillPort, Activity::Memory})
    EXPECT_GT(cycles_of[static_cast<int>(activity)], 100u) << name_of(activity);
}

TEST(Fetch, does_what_the_model_does_in_every_cycle_with_one_port_and_masks) {
  const test::World world(kScene, cull::Design::Projection, 15);
  expect_twins<VFetchOnePort>(world, world.image(), kAllCells, 128, 1);
}

TEST(Fetch, does_what_the_model_does_in_every_cycle_with_two_ports_and_compressed_masks) {
  const test::World world(kScene, cull::Design::BitTable, 15, {.entries = 64});
  ASSERT_EQ(world.image().layout.mask_bits, 6u);
  expect_twins<VFetchTwoPorts>(world, world.image(), 63, 64, 2);
}

TEST(Fetch, does_what_the_model_does_in_every_cycle_with_four_ports_and_no_masks) {
  const test::World world(kScene, cull::Design::None, 15);
  expect_twins<VFetchFourPorts>(world, world.image(), 0, 32, 4);
}

/// Also where nodes and triangles are aligned and the last nodes carry no masks.
TEST(Fetch, finds_bare_nodes_and_padded_triangles) {
  const test::World world(kScene, cull::Design::Projection, 15);
  const cull::ObjectMasks masks = cull::build_object_masks(world.tree(), {}, 1);
  const auto nodes = static_cast<std::uint32_t>(world.tree().nodes.size());
  const accel::Image image = accel::make_image(
      world.tree(), masks.bits.data(), masks.words,
      {.mask_bits = 64, .node_alignment_bytes = 64, .triangle_alignment_bytes = 16, .bare_nodes = nodes / 2});
  expect_twins<VFetchOnePort>(world, image, kAllCells, 128, 1);
}

template <class Model>
void expect_caught() {
  const test::World world(kScene, cull::Design::None, 15);
  const Caches caches{8, 16, 4, 16, 4, 3, 8, MemoryModel::Banked};
  const Compared compared =
      compare<Model>(world, world.image(), config_of(world.config(), caches, 32, 4), 0, oracle::test_seed());
  EXPECT_NE(compared.difference, "");
  std::cout << compared.difference << '\n';
}

TEST(FetchMutants, two_new_lines_asked_of_memory_in_one_cycle_are_caught) { expect_caught<VMutantFetchTwoRequests>(); }
TEST(FetchMutants, a_replacement_that_ignores_hits_is_caught) { expect_caught<VMutantFetchFirstInFirstOut>(); }
TEST(FetchMutants, the_highest_free_register_in_place_of_the_lowest_is_caught) {
  expect_caught<VMutantFetchHighestRegister>();
}
TEST(FetchMutants, a_turn_that_stays_with_the_context_that_left_is_caught) { expect_caught<VMutantFetchTurnStays>(); }
TEST(FetchMutants, a_context_that_leaves_before_the_end_of_its_data_reads_is_caught) {
  expect_caught<VMutantFetchReadsUncounted>();
}

}  // namespace
}  // namespace ctu::rtl
