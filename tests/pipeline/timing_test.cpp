// The unit's time against closed forms: latency of a lonely ray, peak rates, bandwidth, Little's law, accounts.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "model/pipeline/table_lines.h"
#include "tests/pipeline/world.h"

namespace ctu::test {
namespace {

using cull::Design;
using pipeline::Cycle;
using pipeline::UnitConfig;
using pipeline::UnitResult;

UnitConfig ideal(UnitConfig config) {
  config.memory.model = pipeline::MemoryModel::Ideal;
  return config;
}

Cycle lines_of(std::uint64_t address, std::uint64_t bytes, int line) {
  const auto l = static_cast<std::uint64_t>(line);
  return (address + bytes - 1) / l - address / l + 1;
}

/// Cycles from taking a token to the cycle in which it is handed on, all lines missing or all hitting.
Cycle fetch_time(const UnitConfig& c, const pipeline::CacheConfig& cache, Cycle lines, bool miss) {
  if (!miss)
    return (lines + static_cast<Cycle>(cache.ports) - 1) / static_cast<Cycle>(cache.ports) - 1 +
           static_cast<Cycle>(cache.hit_latency) + 1;
  // The last line is asked for, waits for its turn, travels, is taken, and the ray leaves in the cycle behind that.
  return 1 + (lines - 1) * static_cast<Cycle>(std::max(1, c.memory.interval)) + static_cast<Cycle>(c.memory.latency) +
         1 + 1;
}

/// Lines that one lane's test asks of tables in memory, round after round; each lies in a line of its own.
std::vector<Cycle> table_lines(const World& world) {
  const Cycle lut = world.tester().compression_lut() != nullptr ? 1 : 0;
  switch (world.tester().design()) {
    case Design::MaskLut:
      return {1 + lut};
    case Design::BitTable:
      return {1};
    case Design::Dedup:
      return {1, 1};
    case Design::Projection:
      return {3 + lut};
    default:
      return {lut};
  }
}

/// Cycles between the box test and the sort, for a node of which one lane is asked.
Cycle mask_time(const World& world, const UnitConfig& c, bool miss) {
  const auto n = [](int cycles) { return static_cast<Cycle>(cycles); };
  const Design design = c.mask_test.design;
  if (design == Design::None) return 0;
  const Cycle hop = 1;
  Cycle time = hop + n(design == Design::Comparators ? c.comparators.latency : c.cell_locate.latency);
  const bool cached = c.table_cache.bytes > 0 && table_lines(world).front() > 0;
  if (cached) {
    time += hop;
    for (const Cycle lines : table_lines(world)) time += fetch_time(c, c.table_cache, lines, miss);
  }
  time += hop + n(c.mask_test.latency);
  return time + (design == Design::Dedup && !cached ? n(c.mask_test.second_latency) : 0);
}

/// From the cycle in which a lonely ray takes its context to the cycle in which it is returned, for a root with one
/// leaf.
Cycle lonely_latency(const World& world, const UnitConfig& c, int triangles, bool miss) {
  const Cycle hop = 1;  // a token is taken in the cycle behind the one in which it was handed on
  const auto& image = world.image();
  const Cycle node_lines = lines_of(image.node_address(0), image.node_stride_bytes, c.memory.line_bytes);
  const Cycle leaf_lines =
      lines_of(image.triangle_address(0), static_cast<std::uint64_t>(triangles) * image.triangle_stride_bytes,
               c.memory.line_bytes);
  const auto n = [](int cycles) { return static_cast<Cycle>(cycles); };
  const Cycle scheduling = hop + 1;
  Cycle time = n(c.ray_setup.interval - 1 + c.ray_setup.latency);
  time += scheduling + hop + fetch_time(c, c.node_cache, node_lines, miss);
  if (image.layout.box_bits != accel::kFullBoxBits) time += n(c.box_decode.latency);
  time += hop + n(c.box_test.latency) + mask_time(world, c, miss) + hop + n(c.child_sort.latency);
  time += hop + 1;  // the stack forwards the nearest child
  time += scheduling + hop + fetch_time(c, c.leaf_cache, leaf_lines, miss);
  if (image.layout.primitive_boxes)
    time += hop + n((triangles + c.primitive_cull.units - 1) / c.primitive_cull.units - 1 + c.primitive_cull.latency);
  time += hop + n(triangles * c.triangle_test.interval - 1 + c.triangle_test.latency);
  if (image.sphere_count != 0) time += hop + n(c.sphere_test.latency);
  time += hop + n(c.hit_update.latency);
  time += hop + 1;  // the stack finds nothing
  return time + hop;
}

std::vector<UnitConfig> single_ray_configs(const World& world) {
  std::vector<UnitConfig> configs(8, ideal(world.config()));
  configs[1].memory.line_bytes = 64;
  configs[1].box_test.latency = 1;
  configs[1].box_decode.latency = 8;
  configs[2].box_decode.latency = 1;
  configs[1].child_sort.latency = 7;
  configs[2].memory.latency = 400;
  configs[2].memory.interval = 9;
  configs[2].memory.line_bytes = 64;
  configs[3].triangle_test.interval = 4;
  configs[3].triangle_test.latency = 90;
  configs[3].hit_update.latency = 1;
  configs[3].primitive_cull = {.units = 4, .latency = 1};
  configs[4].primitive_cull = {.units = 2, .latency = 17};
  configs[4].sphere_test.latency = 1;
  configs[4].ray_setup = {.latency = 3, .interval = 17};
  configs[4].cell_locate.latency = 1;
  configs[4].comparators.latency = 31;
  configs[4].mask_test.latency = 5;
  configs[4].mask_test.second_latency = 6;
  configs[5].node_cache.ports = 2;
  configs[5].node_cache.hit_latency = 20;
  configs[5].leaf_cache.hit_latency = 1;
  configs[5].memory.line_bytes = 64;
  configs[6].table_cache = {.bytes = 8192, .hit_latency = 7, .ports = 1};
  configs[7].table_cache = {.bytes = 8192, .hit_latency = 1, .ports = 2};
  configs[7].memory.line_bytes = 64;
  configs[7].memory.interval = 23;
  configs[7].mask_test.second_latency = 8;
  for (UnitConfig& config : configs) {
    config.unit.contexts = 1;
    config.stack.spill_batch = 4;  // 16 bytes an entry in lines of 64
  }
  return configs;
}

TEST(Timing, a_lonely_ray_takes_exactly_the_sum_of_its_latencies_cold_and_warm) {
  constexpr cull::MaskOptions kPlain{}, kCompressed{.entries = 16};
  const std::pair<Design, cull::MaskOptions> cases[] = {{Design::None, kPlain},
                                                        {Design::MaskLut, kPlain},
                                                        {Design::Dedup, kPlain},
                                                        {Design::Projection, kPlain},
                                                        {Design::Comparators, kPlain},
                                                        {Design::MaskLut, kCompressed},
                                                        {Design::BitTable, kCompressed},
                                                        {Design::Dedup, kCompressed},
                                                        {Design::Projection, kCompressed},
                                                        {Design::Comparators, kCompressed}};
  for (const auto& [design, options] : cases)
    for (const int triangles : {1, 5, 7}) {
      const bool spheres = triangles == 7, primitive_boxes = triangles != 1;
      accel::Bvh4 tree = stacked_leaves(1, triangles);
      if (spheres) {
        tree.spheres = 2;
        for (const std::uint32_t i : {0u, 6u}) tree.triangles[i] = accel::LeafTriangle::of({{1.5f, 1.5f, 2}, 0.75f}, i);
      }
      // Two equal rays and one context: the second starts when the first is gone, with warm caches.
      const std::uint32_t box_bits = triangles == 1 ? accel::kFullBoxBits : 12;
      World world(tree, design, std::vector<intersect::Ray>(2, ray_through_leaves()), options, box_bits,
                  primitive_boxes);
      int number = 0;
      for (const UnitConfig& config : single_ray_configs(world))
        for (const bool exec : {false, true}) {
          SCOPED_TRACE(std::string(cull::to_string(design)) + ", " + std::to_string(options.entries) +
                       " entries, config " + std::to_string(number++ / 2));
          const UnitResult result = world.run(config, {.exec = exec});
          EXPECT_EQ(result.ray_latency_sum,
                    lonely_latency(world, config, triangles, true) + lonely_latency(world, config, triangles, false));
          EXPECT_EQ(result.wrong_hits, 0u);
          EXPECT_EQ(result.counts.uncertain, 0u);
        }
    }
}

TEST(Timing, lanes_with_full_masks_pass_unasked_and_take_no_turn_anywhere) {
  for (const Design design : {Design::MaskLut, Design::Dedup, Design::Projection, Design::Comparators})
    for (const int table_cache_bytes : {0, 4096}) {
      SCOPED_TRACE(cull::to_string(design));
      World world(filled_leaves(4), design, {ray_through_leaves()});
      UnitConfig config = ideal(world.config());
      config.table_cache.bytes = table_cache_bytes;
      const UnitResult result = world.run(config);
      EXPECT_EQ(counter(result, "mask_test.lanes_unasked"), 4u);
      EXPECT_EQ(counter(result, "cell_locate.lanes"), 0u);
      EXPECT_EQ(counter(result, "mask_test.reads"), 0u);
      EXPECT_EQ(result.counts.box_hits, 4u);
      EXPECT_EQ(result.counts.culled + result.counts.uncertain, 0u);
      // Four lanes take the time of none, however few units locate: a unit for each makes no difference.
      config.cell_locate.units = config.comparators.units = 4;
      EXPECT_EQ(world.run(config).cycles, result.cycles);
      EXPECT_EQ(world.run(config, {.exec = true}).cycles, result.cycles);
      if (table_cache_bytes == 0) continue;
      // Nothing to fetch: table_fetch hands the node on in the cycle behind the one in which it takes it.
      config.table_cache.bytes = 0;
      const Cycle second_read = design == Design::Dedup ? static_cast<Cycle>(config.mask_test.second_latency) : 0;
      const bool fetches = cull::reads_tables(design);
      if (fetches) {
        EXPECT_EQ(counter(result, "table_fetch.lookups"), 0u);
      }
      EXPECT_EQ(world.run(config).cycles + (fetches ? 2 : 0), result.cycles + second_read);
    }
}

/// Rows that the recorded rays read of a table that is read by key alone, and the lanes whose masks are full.
struct KeysRead {
  std::set<std::uint32_t> numbers;
  std::uint64_t unasked = 0;
};
KeysRead keys_read(const World& world) {
  KeysRead read;
  for (const auto& block : world.blocks()) {
    std::size_t next_key = 0;
    for (const reference::Step& step : block->steps.steps)
      for (int lane = 0; lane < intersect::kLanes && !step.is_leaf(); ++lane) {
        if ((step.box_hits() >> lane & 1) == 0) continue;
        const cull::CellKey key{block->steps.keys[next_key++]};
        std::uint64_t mask = 0;
        accel::read_mask(world.image(), step.ref, lane, &mask);
        if (mask == ~std::uint64_t{0})
          ++read.unasked;
        else if (!key.uncertain())
          read.numbers.insert(cull::key_number(key, world.tester().options().ray_resolution));
      }
  }
  return read;
}

TEST(Timing, a_table_cache_that_holds_all_lines_misses_each_once_and_a_small_one_costs_cycles) {
  World world("gen:hair-ball?strands=120", Design::MaskLut, 300, {.ray_resolution = 5});
  const KeysRead read = keys_read(world);
  std::set<std::uint32_t> lines;
  for (const std::uint32_t number : read.numbers) lines.insert(number / 16);  // rows of 8 bytes, lines of 128
  UnitConfig config = world.config();
  config.table_cache.bytes = 1 << 18;
  const UnitResult large = world.run(config);
  EXPECT_EQ(counter(large, "mask_test.rows_used"), read.numbers.size());
  EXPECT_EQ(counter(large, "mask_test.lanes_unasked"), read.unasked);
  EXPECT_EQ(counter(large, "table_fetch.fills"), lines.size());
  EXPECT_EQ(counter(large, "table_fetch.evictions"), 0u);
  EXPECT_EQ(counter(large, "memory.table_requests"), lines.size());
  EXPECT_EQ(counter(large, "table_fetch.lookups"),
            counter(large, "table_fetch.hits") + counter(large, "table_fetch.merges") + lines.size());
  EXPECT_EQ(counter(large, "mask_test.on_chip_bits"), 8u << 18);
  EXPECT_EQ(counter(large, "mask_test.table_bits"), 64u * 15625);

  config.table_cache.bytes = 512;
  const UnitResult small = world.run(config);
  EXPECT_EQ(counter(small, "table_fetch.lookups"), counter(large, "table_fetch.lookups"));
  EXPECT_GT(counter(small, "table_fetch.evictions"), 0u);
  EXPECT_GT(counter(small, "memory.table_requests"), lines.size());
  EXPECT_GT(small.cycles, large.cycles);
}

TEST(TableLayout, rows_lie_apart_behind_the_spilled_entries_and_cross_no_line_they_need_not) {
  const std::pair<Design, cull::MaskOptions> cases[] = {
      {Design::Dedup, {}},
      {Design::MaskLut, {.entries = 16}},
      {Design::Projection, {.resolution = 6, .ray_resolution = 7, .entries = 16}},
      {Design::Dedup, {.resolution = 3, .ray_resolution = 4, .entries = 16}},
      {Design::MaskLut, {.resolution = 7, .ray_resolution = 7}}};
  for (const auto& [design, options] : cases) {
    SCOPED_TRACE(std::string(cull::to_string(design)) + ", R " + std::to_string(options.resolution));
    World world(stacked_leaves(2, 3), design, {}, options);
    UnitConfig config = world.config();
    config.memory.line_bytes = 32;
    const cull::OnChipTables tables(world.tester(), cull::TableRows::All, 3);
    const pipeline::UnitImage image(world.image(), world.tester(), false);
    const pipeline::MemoryMap map(config, image);
    const pipeline::TableLayout layout(config, tables, map, image.compressed());
    ASSERT_GE(map.table_base, image.end() + static_cast<std::uint64_t>(config.unit.contexts * image.stack_bound() * 8));
    std::uint64_t free_from = map.table_base;
    for (std::size_t t = 0; t < tables.tables().size(); ++t) {
      const bool by_bit = design == Design::Dedup && options.entries > 0 && t == 1;
      const std::uint64_t bytes = by_bit ? 1 : (tables.tables()[t].row_bits + 7) / 8;
      for (std::uint32_t row = 0; row < tables.tables()[t].rows; row += 1 + row / 64) {
        const auto span = layout.bytes({static_cast<std::uint8_t>(t), row}, 0);
        ASSERT_GE(span.first, free_from);
        ASSERT_EQ(span.last - span.first + 1, bytes);
        ASSERT_EQ(span.last / 32 - span.first / 32 + 1, (bytes + 31) / 32);
        free_from = span.last + 1;
      }
      if (by_bit) {
        EXPECT_EQ(layout.bytes({1, 1}, 15).first, layout.bytes({1, 1}, 0).first + 1);
      }
    }
    EXPECT_GE(layout.end(), free_from);
  }
}

TEST(Timing, a_ray_that_the_unit_does_not_accept_takes_its_set_up_and_two_hops) {
  intersect::Ray invalid;
  World world(stacked_leaves(1, 1), Design::None, {invalid});
  UnitConfig config = ideal(world.config());
  const UnitResult result = world.run(config);
  EXPECT_EQ(result.ray_latency_sum, static_cast<Cycle>(config.ray_setup.interval - 1 + config.ray_setup.latency + 1));
  EXPECT_EQ(result.cycles, result.ray_latency_sum + 1);
  EXPECT_EQ(result.counts.node_visits, 0u);
}

/// A small scene that fits the caches, and a unit that is wide everywhere.
World& small_world() {
  static World world("gen:tilted-quads?quads=40", Design::None, 2000);
  return world;
}
UnitConfig wide(UnitConfig config) {
  config = ideal(config);
  config.unit.contexts = 256;
  config.ray_setup.interval = 1;
  config.node_cache.ports = config.leaf_cache.ports = 8;
  config.stack.push_width = 3;
  return config;
}

TEST(Timing, the_slowest_stage_sets_the_pace_and_is_never_outrun) {
  World& world = small_world();
  const reference::Counts counts = world.counts();
  const auto pace = [&](UnitConfig config, std::uint64_t bound) {
    const UnitResult result = world.run(config);
    EXPECT_GE(result.cycles, bound);
    EXPECT_LE(static_cast<double>(result.cycles), 1.05 * static_cast<double>(bound) + 1500);
  };
  UnitConfig config = wide(world.config());
  config.triangle_test.interval = 100;
  pace(config, counts.triangle_tests * 100);
  config = wide(world.config());
  config.result.interval = 200;
  pace(config, (counts.rays - 1) * 200);
  config = wide(world.config());
  config.ray_setup.interval = 90;
  pace(config, counts.rays * 90);
  // Everything at one a cycle: the scheduler's issues are the bound.
  config = wide(world.config());
  pace(config, counts.node_visits + counts.leaf_visits);
}

TEST(Timing, memory_bandwidth_bounds_a_unit_without_caches) {
  World& world = small_world();
  UnitConfig config = wide(world.config());
  config.node_cache.bytes = config.leaf_cache.bytes = 0;
  config.node_cache.mshrs = config.leaf_cache.mshrs = 64;
  config.memory.interval = 16;
  const UnitResult result = world.run(config);
  const std::uint64_t lines = counter(result, "memory.node_requests") + counter(result, "memory.leaf_requests");
  EXPECT_GE(result.cycles, lines * 16);
  EXPECT_LE(static_cast<double>(result.cycles), 1.02 * static_cast<double>(lines * 16) + 1500);
}

TEST(Timing, latency_sum_equals_the_occupied_contexts_summed_over_cycles) {
  World world("gen:hair-ball?strands=60", Design::Projection, 300);
  const auto engine = world.engine(world.config(), {});
  std::uint64_t occupied = 0;
  Cycle next = 1;
  while (!engine->advance(next)) {
    occupied += static_cast<std::uint64_t>(engine->occupied_contexts());
    ++next;
  }
  const UnitResult result = engine->result();
  EXPECT_EQ(occupied, result.ray_latency_sum);
  EXPECT_EQ(counter(result, "contexts.occupied_cycles"), result.ray_latency_sum);
  EXPECT_EQ(world.run(world.config()).cycles, result.cycles) << "a cycle at a time is the same as at once";
}

TEST(Timing, every_cycle_of_every_stage_and_of_every_ray_is_accounted_for) {
  for (const Design design : {Design::None, Design::MaskLut, Design::Dedup, Design::Projection, Design::Comparators}) {
    World world("gen:foliage?twigs=10", design, 400);
    for (const bool small : {false, true}) {
      UnitConfig config = world.config();
      if (small) {
        config.node_cache.bytes = config.leaf_cache.bytes = 2048;
        config.node_cache.mshrs = config.leaf_cache.mshrs = 2;
        config.stack = {.entries = 2, .push_width = 1, .spill_batch = 2};
        config.mask_test.banks = 1;
        config.table_cache = {.bytes = 1024, .ways = 2, .mshrs = 1};
      }
      const UnitResult result = world.run(config);
      const bool reads_tables = cull::reads_tables(design);
      EXPECT_EQ(result.stages.size(), design == Design::None ? 11u : small && reads_tables ? 14u : 13u);
      for (const auto& stage : result.stages) {
        std::uint64_t cycles = stage.busy + stage.idle;
        for (const auto& cause : stage.stalled) cycles += cause.cycles;
        EXPECT_EQ(cycles, result.cycles) << stage.stage;
      }
      std::uint64_t ray_cycles = 0;
      for (const auto& cause : result.ray_cycles) ray_cycles += cause.cycles;
      EXPECT_EQ(ray_cycles, result.ray_latency_sum);
    }
  }
}

TEST(Timing, bank_conflicts_cost_the_extra_turns_and_are_charged_as_such) {
  // Four lanes hit at once by the same ray in equal boxes ask for the same row: no conflict, whatever the banks.
  World same(stacked_leaves(4, 1), Design::MaskLut, {ray_through_leaves()});
  UnitConfig config = ideal(same.config());
  config.mask_test.banks = 1;
  const UnitResult shared = same.run(config);
  EXPECT_EQ(counter(shared, "mask_test.reads") + counter(shared, "mask_test.shared_reads") + shared.counts.uncertain,
            4u);
  const auto conflicts = [](const UnitResult& result) {
    for (const auto& stage : result.stages)
      if (stage.stage == "mask_test")
        for (const auto& cause : stage.stalled)
          if (cause.name == "bank_conflict") return cause.cycles;
    return std::uint64_t{0};
  };
  EXPECT_EQ(conflicts(shared), 0u);
  // A single projection table with one port serves the three reads of a certain lane in three turns.
  World single(stacked_leaves(1, 1), Design::Projection, {ray_through_leaves()});
  config = ideal(single.config());
  config.mask_test.banks = 1;
  config.mask_test.projection_tables = 1;
  const UnitResult one_table = single.run(config);
  config.mask_test.projection_tables = 3;
  const UnitResult three_tables = single.run(config);
  const std::uint64_t extra =
      counter(one_table, "mask_test.reads") - (counter(one_table, "mask_test.reads") > 0 ? 1 : 0);
  EXPECT_EQ(conflicts(one_table), extra);
  EXPECT_EQ(one_table.cycles, three_tables.cycles + extra);
}

}  // namespace
}  // namespace ctu::test
