// Contract 3 on the whole unit: time never changes an answer; and the executions agree to the cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/scene/load.h"
#include "tests/oracle/seed.h"
#include "tests/pipeline/world.h"

namespace ctu::test {
namespace {

using cull::Design;
using pipeline::EngineOptions;
using pipeline::UnitConfig;
using pipeline::UnitResult;

/// A design over masks of some kind.
struct Case {
  Design design;
  cull::MaskOptions masks = {};
  std::uint32_t box_bits = accel::kFullBoxBits;
  bool spheres = false, primitive_boxes = false;
};
constexpr cull::MaskOptions kCompressed{.entries = 64};
constexpr Case kCases[] = {{Design::None},
                           {Design::MaskLut},
                           {Design::Dedup},
                           {Design::Projection},
                           {Design::Comparators},
                           {Design::MaskLut, kCompressed},
                           {Design::BitTable, kCompressed},
                           {Design::Dedup, kCompressed},
                           {Design::Projection, kCompressed},
                           {Design::Comparators, kCompressed},
                           {Design::BitTable, {.resolution = 3, .ray_resolution = 5, .entries = 16}},
                           {Design::Projection, {.resolution = 6, .ray_resolution = 13}},
                           {Design::Projection, {.resolution = 8, .ray_resolution = 24}},
                           {Design::Comparators, {.resolution = 6, .ray_resolution = 6, .entries = 200}},
                           {Design::None, {}, 8},
                           {Design::Projection, {}, 12},
                           {Design::BitTable, kCompressed, 16},
                           {Design::Comparators, {.resolution = 6, .ray_resolution = 6}, 8},
                           {.design = Design::None, .spheres = true},
                           {.design = Design::Projection, .primitive_boxes = true},
                           {.design = Design::None, .spheres = true, .primitive_boxes = true},
                           {.design = Design::MaskLut, .box_bits = 16, .spheres = true, .primitive_boxes = true}};

std::string name_of(const Case& c) {
  return std::string(cull::to_string(c.design)) + ", R " + std::to_string(c.masks.resolution) + ", R_ray " +
         std::to_string(c.masks.ray_resolution) + ", " + std::to_string(c.masks.entries) + " entries, " +
         std::to_string(c.box_bits) + " bits" + (c.spheres ? ", spheres" : "") +
         (c.primitive_boxes ? ", primitive boxes" : "");
}

/// With primitive boxes leaves are as large as they get, so that there is something to cull in them.
accel::Bvh4 tree_of(const Case& c) {
  scene::Mesh mesh = scene::load("gen:hair-ball?strands=120").mesh;
  if (c.spheres) add_spheres(mesh);
  if (!c.primitive_boxes) return accel::build(mesh, {});
  return accel::build(mesh, {.max_leaf_triangles = accel::kMaxLeafTriangles, .triangle_cost = 0.01f});
}

World& world_of(const Case& c) {
  static std::map<std::string, std::unique_ptr<World>> worlds;
  auto& world = worlds[name_of(c)];
  if (!world) world = std::make_unique<World>(tree_of(c), c.design, 200, c.masks, c.box_bits, c.primitive_boxes);
  return *world;
}

/// Units that differ in every parameter that time depends on.
std::vector<UnitConfig> timing_configs(const World& world) {
  std::vector<UnitConfig> configs(24, world.config());
  const auto set = [&](std::size_t i) -> UnitConfig& { return configs[i]; };
  set(1).unit.contexts = 1;
  set(2).unit.contexts = 256;
  set(3).scheduler.policy = pipeline::SchedulerPolicy::RoundRobin;
  set(4).node_cache.bytes = set(4).leaf_cache.bytes = 0;
  set(5).node_cache = {.bytes = 1024, .ways = 1, .hit_latency = 20, .ports = 2, .mshrs = 1};
  set(6).leaf_cache = {.bytes = 1024, .ways = 8, .hit_latency = 1, .ports = 4, .mshrs = 64};
  set(7).memory.model = pipeline::MemoryModel::Ideal;
  set(8).memory.model = pipeline::MemoryModel::Ideal;
  set(8).memory.latency = 1;
  set(8).memory.interval = 1;
  set(9).memory.channels = 1;
  set(9).memory.queue_depth = 1;
  set(10).memory.t_rfc = 0;
  set(10).memory.burst = 40;
  set(11).stack = {.entries = 1, .push_width = 1, .spill_batch = 1};
  set(12).stack = {.entries = 3, .push_width = 3, .spill_batch = 2};
  set(13).box_test.latency = 1;
  set(13).box_decode.latency = 1;
  set(14).box_decode.latency = 31;
  set(13).child_sort.latency = 1;
  set(13).mask_test.latency = 1;
  set(13).cell_locate.latency = 1;
  set(13).mask_test.second_latency = 9;
  set(14).cell_locate.units = set(14).comparators.units = 4;
  set(14).mask_test.banks = 64;
  set(15).mask_test.banks = 1;
  set(15).mask_test.projection_tables = 1;
  set(16).triangle_test = {.latency = 1, .interval = 1};
  set(16).hit_update.latency = 9;
  set(17).triangle_test = {.latency = 100, .interval = 13};
  set(18).ray_setup = {.latency = 1, .interval = 1};
  set(18).result.interval = 40;
  set(19).memory.line_bytes = 64;
  set(19).unit.contexts = 7;
  set(19).stack.spill_batch = set(22).stack.spill_batch = 4;  // 16 bytes an entry in lines of 64
  set(19).node_cache.bytes = 4096;
  set(19).scheduler.policy = pipeline::SchedulerPolicy::RoundRobin;
  set(20).table_cache.bytes = 16384;
  set(21).table_cache = {.bytes = 1024, .ways = 1, .hit_latency = 9, .ports = 2, .mshrs = 1};
  set(21).mask_test.rows = cull::TableRows::Folded;
  set(21).stack = {.entries = 2, .push_width = 1, .spill_batch = 2};
  set(22).table_cache = {.bytes = 2048, .ways = 4, .hit_latency = 1, .ports = 8, .mshrs = 64};
  set(22).memory.line_bytes = 64;
  set(22).mask_test.latency = 1;
  set(22).primitive_cull = {.units = 4, .latency = 1};
  set(22).sphere_test.latency = 1;
  set(12).primitive_cull = {.units = 3, .latency = 40};
  set(12).sphere_test.latency = 100;
  set(23).mask_test.ports = 2;
  set(23).mask_test.banks = 1;
  set(23).mask_test.rows = cull::TableRows::Folded;
  return configs;
}

struct Outcome {
  UnitResult result;
  std::uint64_t untimed_hash = 0;
};
Outcome run(World& world, const UnitConfig& config, const EngineOptions& options = {}) {
  const auto engine = world.engine(config, options);
  Outcome outcome{pipeline::run_to_end(*engine), 0};
  outcome.untimed_hash = engine->log().untimed_hash();
  return outcome;
}

void expect_same_answers(const World& world, const Outcome& outcome, std::uint64_t untimed_hash) {
  EXPECT_EQ(outcome.result.wrong_hits, 0u);
  EXPECT_EQ(outcome.result.rays, world.rays());
  EXPECT_EQ(outcome.untimed_hash, untimed_hash);
}

TEST(Contract, the_events_of_each_ray_are_those_the_reference_recorded) {
  for (const Case& c : kCases)
    for (const bool exec : {false, true}) {
      SCOPED_TRACE(name_of(c) + (exec ? ", exec" : ", replay"));
      World& world = world_of(c);
      const auto engine = world.engine(world.config(), {.exec = exec, .keep_events = true});
      const UnitResult result = pipeline::run_to_end(*engine);
      EXPECT_EQ(result.wrong_hits, 0u);
      auto events = engine->log().events();
      std::sort(events.begin(), events.end(),
                [](const auto& a, const auto& b) { return std::tie(a.ray, a.visit) < std::tie(b.ray, b.visit); });
      std::size_t next = 0;
      for (const auto& block : world.blocks())
        for (std::size_t ray = 0; ray < block->rays.size(); ++ray) {
          for (auto s = block->steps.first_step[ray]; s < block->steps.first_step[ray + 1]; ++s, ++next) {
            ASSERT_LT(next, events.size());
            ASSERT_EQ(events[next].ray, block->first_ray + ray);
            ASSERT_EQ(events[next].step, block->steps.steps[s]) << "ray " << events[next].ray;
            ASSERT_FALSE(events[next].is_return);
          }
          ASSERT_TRUE(events[next].is_return);
          ASSERT_EQ(events[next++].step.ref, block->expected[ray].primitive);
        }
      EXPECT_EQ(next, events.size());
      const auto recorded = world.counts();
      EXPECT_EQ(result.counts.node_visits, recorded.node_visits);
      EXPECT_EQ(result.counts.leaf_visits, recorded.leaf_visits);
      EXPECT_EQ(result.counts.triangle_tests, recorded.triangle_tests);
      EXPECT_EQ(result.counts.boxed_out, recorded.boxed_out);
      if (c.primitive_boxes) {
        EXPECT_GT(counter(result, "primitive_cull.culled"), 500u);
        EXPECT_GT(counter(result, "primitive_cull.emptied"), 20u);
      }
      if (c.spheres) EXPECT_GT(counter(result, "sphere_test.spheres"), 100u);
      EXPECT_EQ(result.counts.box_hits, recorded.box_hits);
      EXPECT_EQ(result.counts.culled, recorded.culled);
      EXPECT_EQ(result.counts.uncertain, recorded.uncertain);
      EXPECT_EQ(result.counts.dropped, recorded.dropped);
    }
}

TEST(Contract, no_timing_changes_what_a_ray_visits_or_finds_and_exec_takes_the_cycles_of_replay) {
  for (const Case& c : kCases) {
    World& world = world_of(c);
    const std::uint64_t untimed_hash = run(world, world.config()).untimed_hash;
    int number = 0;
    for (const UnitConfig& config : timing_configs(world)) {
      SCOPED_TRACE(name_of(c) + ", config " + std::to_string(number++));
      const Outcome replay = run(world, config), exec = run(world, config, {.exec = true});
      expect_same_answers(world, replay, untimed_hash);
      expect_same_answers(world, exec, untimed_hash);
      EXPECT_EQ(exec.result.cycles, replay.result.cycles);
      EXPECT_EQ(exec.result.event_log_hash, replay.result.event_log_hash);
      EXPECT_EQ(exec.result.other_visits, 0u);
    }
  }
}

TEST(Contract, the_order_of_the_stages_and_skipping_idle_cycles_change_no_cycle) {
  for (const Case& c : kCases) {
    World& world = world_of(c);
    int number = 0;
    for (const UnitConfig& config : timing_configs(world)) {
      SCOPED_TRACE(name_of(c) + ", config " + std::to_string(number++));
      const UnitResult forward = world.run(config);
      const UnitResult backward = world.run(config, {.skip_idle = false, .reverse_order = true});
      const UnitResult ticking = world.run(config, {.skip_idle = false});
      for (const UnitResult* other : {&backward, &ticking}) {
        EXPECT_EQ(other->cycles, forward.cycles);
        EXPECT_EQ(other->event_log_hash, forward.event_log_hash);
        EXPECT_EQ(other->ray_latency_sum, forward.ray_latency_sum);
        ASSERT_EQ(other->stages.size(), forward.stages.size());
        for (std::size_t s = 0; s < forward.stages.size(); ++s) {
          EXPECT_EQ(other->stages[s].busy, forward.stages[s].busy) << forward.stages[s].stage;
          EXPECT_EQ(other->stages[s].idle, forward.stages[s].idle) << forward.stages[s].stage;
        }
      }
    }
  }
}

TEST(Contract, links_that_refuse_at_random_change_no_answer) {
  for (const Case& c : kCases) {
    World& world = world_of(c);
    const Outcome undisturbed = run(world, world.config());
    const auto configs = timing_configs(world);
    for (std::uint64_t i = 0; i < configs.size(); ++i) {
      const std::uint64_t seed = oracle::test_seed() + i;
      SCOPED_TRACE(name_of(c) + ", config " + std::to_string(i) + ", stall seed " + std::to_string(seed));
      const Outcome outcome = run(world, configs[i], {.exec = i % 2 == 0, .backpressure = {.seed = seed}});
      expect_same_answers(world, outcome, undisturbed.untimed_hash);
      const Outcome backward = run(world, configs[i], {.reverse_order = true, .backpressure = {.seed = seed}});
      EXPECT_EQ(backward.result.cycles, outcome.result.cycles);
      EXPECT_EQ(backward.result.event_log_hash, outcome.result.event_log_hash);
    }
  }
}

TEST(Contract, exec_needs_no_recorded_steps) {
  World world("gen:tilted-quads?quads=100", Design::Comparators, 200);
  const UnitResult with = world.run(world.config(), {.exec = true});
  world.forget_steps();
  const UnitResult without = world.run(world.config(), {.exec = true});
  EXPECT_EQ(with.event_log_hash, without.event_log_hash);
  EXPECT_THROW(world.run(world.config()), Error);
}

TEST(Contract, a_stack_of_one_entry_spills_and_comes_back_exactly) {
  World& world = world_of({Design::None});
  UnitConfig config = world.config();
  config.stack = {.entries = 1, .push_width = 3, .spill_batch = 1};
  const Outcome small = run(world, config), large = run(world, world.config());
  expect_same_answers(world, small, large.untimed_hash);
  const UnitResult& result = small.result;
  EXPECT_GT(counter(result, "stack.spills"), 100u);
  EXPECT_EQ(counter(result, "memory.stack_requests"),
            counter(result, "stack.spills") + counter(result, "stack.refills"));
  EXPECT_LE(counter(result, "stack.refills"), counter(result, "stack.spills"));  // any-hit rays leave theirs behind
  EXPECT_EQ(counter(result, "stack.deepest"), counter(large.result, "stack.deepest"));
}

TEST(Contract, wrong_hits_are_counted_and_shown) {
  World world("gen:tilted-quads?quads=100", Design::None, 50);
  auto block = std::make_shared<reference::RayBlock>(*world.blocks()[0]);
  block->expected[7].t = 12345;
  block->expected[7].primitive = 3;
  const std::vector<std::shared_ptr<const reference::RayBlock>> blocks{block};
  VectorFeed feed(blocks);
  for (const bool exec : {false, true}) {
    VectorFeed again(blocks);
    const auto engine = pipeline::make_engine(world.config(), {world.image(), world.tester(), again}, {.exec = exec});
    const UnitResult result = pipeline::run_to_end(*engine);
    ASSERT_EQ(result.wrong_hits, 1u);
    EXPECT_EQ(result.first_wrong.at(0).ray, 7u);
    EXPECT_TRUE(intersect::same_bits(result.first_wrong[0].returned, world.blocks()[0]->expected[7]));
  }
}

TEST(Contract, steps_of_another_walk_are_refused_with_ray_and_visit) {
  World world("gen:tilted-quads?quads=100", Design::None, 50);
  auto block = std::make_shared<reference::RayBlock>(*world.blocks()[0]);
  const std::uint64_t visit = block->steps.first_step[5] + 1;
  block->steps.steps[visit].ref ^= 1;
  const std::vector<std::shared_ptr<const reference::RayBlock>> blocks{block};
  VectorFeed feed(blocks);
  const auto engine = pipeline::make_engine(world.config(), {world.image(), world.tester(), feed}, {});
  try {
    pipeline::run_to_end(*engine);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "ray 5, visit 1");
  }
}

TEST(Contract, a_design_other_than_the_tables_is_refused) {
  World& world = world_of({Design::MaskLut});
  UnitConfig config = world.config();
  config.mask_test.design = Design::Projection;
  EXPECT_THROW(world.run(config), Error);
}

TEST(Contract, designs_with_the_same_masks_and_keys_have_the_same_events) {
  const std::vector<Design> by_masks{Design::MaskLut, Design::Dedup, Design::Projection};
  const std::vector<Design> by_index{Design::MaskLut, Design::BitTable, Design::Dedup, Design::Projection};
  for (const auto& [options, designs] : {std::pair(cull::MaskOptions{}, by_masks), std::pair(kCompressed, by_index)})
    for (const Design design : designs) {
      World &first = world_of({Design::MaskLut, options}), &other = world_of({design, options});
      EXPECT_EQ(run(other, other.config(), {.exec = true}).untimed_hash, run(first, first.config()).untimed_hash)
          << name_of({design, options});
    }
}

TEST(Contract, rows_for_rays_from_outside_are_enough_for_those) {
  for (const Case& c : kCases) {
    if (!cull::reads_tables(c.design)) continue;
    SCOPED_TRACE(name_of(c));
    World& world = world_of(c);
    World outside(world.tree(), c.design, rays_from_outside(world), c.masks, c.box_bits, c.primitive_boxes);
    ASSERT_GT(outside.rays(), 50u);
    UnitConfig config = outside.config();
    const Outcome all = run(outside, config);
    config.mask_test.rows = cull::TableRows::Reachable;
    for (const int table_cache_bytes : {0, 4096}) {
      config.table_cache.bytes = table_cache_bytes;
      const Outcome reachable = run(outside, config), exec = run(outside, config, {.exec = true});
      expect_same_answers(outside, reachable, all.untimed_hash);
      expect_same_answers(outside, exec, all.untimed_hash);
      EXPECT_EQ(exec.result.cycles, reachable.result.cycles);
    }
  }
}

TEST(Contract, a_ray_without_a_row_is_refused_with_its_number_resident_or_cached_replayed_or_computed) {
  // Begins and ends in inner cells of the box of 4^3 cells: no ray from outside does, in either direction.
  intersect::Ray inside = ray_through_leaves();
  inside.origin[2] = 1.5f;
  inside.tmax = 1;
  for (const Design design : {Design::MaskLut, Design::BitTable, Design::Dedup})
    for (const int table_cache_bytes : {0, 4096})
      for (const bool exec : {false, true}) {
        SCOPED_TRACE(cull::to_string(design));
        World world(stacked_leaves(1, 1), design, {ray_through_leaves(), inside}, kCompressed);
        UnitConfig config = world.config();
        config.table_cache.bytes = table_cache_bytes;
        config.mask_test.rows = cull::TableRows::Folded;
        EXPECT_EQ(world.run(config, {.exec = exec}).wrong_hits, 0u);
        config.mask_test.rows = cull::TableRows::Reachable;
        try {
          world.run(config, {.exec = exec});
          FAIL() << "answered";
        } catch (const Error& error) {
          EXPECT_EQ(error.where(), "ray 1, visit 0");
          EXPECT_NE(error.remedy().find("mask_test.rows = folded"), std::string::npos);
        }
      }
}

TEST(Contract, a_feed_without_rays_takes_no_cycle) {
  World world(stacked_leaves(1, 1), Design::None, {});
  EXPECT_EQ(world.run(world.config()).cycles, 0u);
}

TEST(Watchdog, a_stuck_link_is_found_and_named) {
  World& world = world_of({Design::Projection});
  UnitConfig config = world.config();
  config.watchdog.cycles = 3000;
  const std::map<int, const char*> names = {{0, "ray_to_scheduler"}, {3, "scheduler_to_node"}, {6, "box_to_locate"},
                                            {9, "sort_to_stack"},    {12, "hit_to_stack"},     {14, "stack_to_result"}};
  for (const auto& [number, name] : names) {
    SCOPED_TRACE(name);
    try {
      world.run(config, {.backpressure = {.stuck_link = number}});
      FAIL() << "ended";
    } catch (const pipeline::DeadlockFound& deadlock) {
      const std::string text = deadlock.what();
      const auto culprit = text.find("refuses although it has room");
      ASSERT_NE(culprit, std::string::npos) << text;
      const auto line = text.rfind('\n', culprit);
      EXPECT_NE(text.substr(line, culprit - line).find(name), std::string::npos) << text;
      EXPECT_NE(text.find("oldest ray: "), std::string::npos) << text;
    }
  }
}

}  // namespace
}  // namespace ctu::test
