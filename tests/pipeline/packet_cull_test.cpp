// Rays that enter the unit in packets: what each visits is what the reference says, in every execution, whatever time
// does; and every cycle of it is accounted for.
#include "model/pipeline/packet_cull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/scene/load.h"
#include "model/unit/run.h"
#include "tests/oracle/seed.h"
#include "tests/pipeline/world.h"

namespace ctu::test {
namespace {

using cull::Design;
using pipeline::EngineOptions;
using pipeline::UnitConfig;
using pipeline::UnitResult;
using reference::PacketPlan;

/// Bundles of `bundle` lines from one point through neighbouring points, every seventh bundle at random; some any-hit,
/// some not valid.
std::vector<intersect::Ray> bundles(const accel::Bvh4& tree, int count, int bundle) {
  std::uint64_t drawn = oracle::test_seed();
  const auto random = [&] { return static_cast<float>(pipeline::mix64(drawn++) >> 40) * 0x1p-24f; };
  const auto point = [&](float beyond) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = tree.lower[axis] + (tree.upper[axis] - tree.lower[axis]) * (random() * (1 + 2 * beyond) - beyond);
    return p;
  };
  std::vector<intersect::Ray> rays;
  Vec3 from, to;
  for (int i = 0; i < count; ++i) {
    if (i % bundle == 0 || i / bundle % 7 == 6) from = point(0.75f), to = point(0);
    intersect::Ray ray;
    ray.origin = from;
    for (int axis = 0; axis < 3; ++axis)
      ray.direction[axis] = to[axis] - from[axis] + (tree.upper[axis] - tree.lower[axis]) * 0.02f * random();
    ray.tmax = i % 3 == 0 ? 1.0f : std::numeric_limits<float>::infinity();
    if (i % 5 == 3) ray.kind = intersect::RayKind::AnyHit;
    if (i % 37 == 36 || i == count - 1) ray.direction = {};
    rays.push_back(ray);
  }
  return rays;
}

struct Case {
  Design design;
  PacketPlan packets;
  std::uint32_t box_bits = accel::kFullBoxBits;
};
constexpr Case kCases[] = {{Design::None, {8, 4}},
                           {Design::Projection, {16, 2}},
                           {Design::Comparators, {4, 1}, 12},
                           {Design::BitTable, {5, 8}},
                           {Design::Dedup, {32, 16}, 8}};

std::string name_of(const Case& c) {
  return std::string(cull::to_string(c.design)) + " in packets of " + std::to_string(c.packets.size) + " with " +
         std::to_string(c.packets.most_entries) + " entries, " + std::to_string(c.box_bits) + " bits";
}

World& world_of(const Case& c) {
  static std::map<std::string, std::unique_ptr<World>> worlds;
  auto& world = worlds[name_of(c)];
  if (!world) {
    const accel::Bvh4 tree = accel::build(scene::load("gen:hair-ball?strands=120").mesh, {});
    world = std::make_unique<World>(tree, c.design, bundles(tree, 230, c.packets.size),
                                    cull::MaskOptions{.entries = c.design == Design::BitTable ? 64 : 0}, c.box_bits);
    world->travel_in(c.packets);
  }
  return *world;
}

std::vector<UnitConfig> timing_configs(const World& world) {
  std::vector<UnitConfig> configs(13, world.config());
  const auto set = [&](std::size_t i) -> UnitConfig& { return configs[i]; };
  set(1).unit.contexts = 32;
  set(1).packet_cull.packets = 1;
  set(2).unit.contexts = 256;
  set(2).packet_cull.packets = 64;
  set(3).scheduler.policy = pipeline::SchedulerPolicy::RoundRobin;
  set(4).packet_cull = {.packets = 2, .latency = 1, .interval = 1};
  set(5).packet_cull = {.packets = 3, .latency = 90, .interval = 17};
  set(6).stack = {.entries = 1, .push_width = 1, .spill_batch = 1};
  set(7).stack = {.entries = 3, .push_width = 3, .spill_batch = 2};
  set(7).node_cache.bytes = 0;
  set(8).memory.model = pipeline::MemoryModel::Ideal;
  set(8).memory.latency = set(8).memory.interval = 1;
  set(8).ray_setup = {.latency = 1, .interval = 1};
  set(9).node_cache = {.bytes = 1024, .ways = 1, .hit_latency = 20, .ports = 2, .mshrs = 1};
  set(10).table_cache = {.bytes = 1024, .ways = 1, .hit_latency = 9, .ports = 2, .mshrs = 1};
  set(11).result.interval = 40;
  set(11).unit.contexts = 33;
  set(11).scheduler.policy = pipeline::SchedulerPolicy::RoundRobin;
  set(12).box_test.latency = 1;
  set(12).child_sort.latency = 1;
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
  EXPECT_EQ(outcome.result.other_visits, 0u);
  EXPECT_EQ(outcome.result.rays, world.rays());
  EXPECT_EQ(outcome.untimed_hash, untimed_hash);
}

void expect_equal(const UnitResult& a, const UnitResult& b) {
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_EQ(a.event_log_hash, b.event_log_hash);
  EXPECT_EQ(a.ray_latency_sum, b.ray_latency_sum);
  ASSERT_EQ(a.counters.size(), b.counters.size());
  for (std::size_t i = 0; i < a.counters.size(); ++i)
    if (a.counters[i].name != "contexts.most_occupied")  // within a cycle it goes by the order of the stages
      EXPECT_EQ(a.counters[i].value, b.counters[i].value) << a.counters[i].name;
  ASSERT_EQ(a.stages.size(), b.stages.size());
  for (std::size_t i = 0; i < a.stages.size(); ++i) {
    EXPECT_EQ(a.stages[i].busy, b.stages[i].busy) << a.stages[i].stage;
    EXPECT_EQ(a.stages[i].idle, b.stages[i].idle) << a.stages[i].stage;
    for (std::size_t c = 0; c < a.stages[i].stalled.size(); ++c)
      EXPECT_EQ(a.stages[i].stalled[c].cycles, b.stages[i].stalled[c].cycles) << a.stages[i].stage;
  }
  ASSERT_EQ(a.ray_cycles.size(), b.ray_cycles.size());
  for (std::size_t i = 0; i < a.ray_cycles.size(); ++i)
    EXPECT_EQ(a.ray_cycles[i].cycles, b.ray_cycles[i].cycles) << a.ray_cycles[i].name;
}

bool is_packets(const pipeline::Event& event) {
  return !event.is_return && !event.step.is_leaf() && (event.step.detail & 0x8000u) != 0;
}

TEST(PacketCull, the_events_of_each_packet_and_of_each_ray_are_those_the_reference_recorded) {
  SCOPED_TRACE(oracle::seed_note());
  for (const Case& c : kCases)
    for (const bool exec : {false, true}) {
      SCOPED_TRACE(name_of(c) + (exec ? ", exec" : ", replay"));
      World& world = world_of(c);
      const auto engine = world.engine(world.config(), {.exec = exec, .keep_events = true});
      const UnitResult result = pipeline::run_to_end(*engine);
      EXPECT_EQ(result.wrong_hits, 0u);
      EXPECT_EQ(result.other_visits, 0u);
      auto events = engine->log().events();
      const auto order = [](const auto& a, const auto& b) {
        return std::tuple(a.ray, !is_packets(a), a.visit) < std::tuple(b.ray, !is_packets(b), b.visit);
      };
      std::sort(events.begin(), events.end(), order);
      std::size_t next = 0;
      for (const auto& block : world.blocks()) {
        std::uint64_t packets_walked = 0;
        for (std::size_t ray = 0; ray < block->rays.size(); ++ray) {
          const auto& packets = block->packets;
          for (std::uint64_t p = packets.packet_of(ray), visit = packets.first_visit[p]; is_packets(events[next]);
               ++visit, ++next) {
            ASSERT_LT(visit, packets.first_visit[p + 1]);
            ASSERT_EQ(events[next].step.ref, packets.visits[visit].node);
            ASSERT_EQ(events[next].step.lanes >> 4, packets.visits[visit].hit());
            ++packets_walked;
          }
          for (auto s = block->steps.first_step[ray]; s < block->steps.first_step[ray + 1]; ++s, ++next) {
            ASSERT_EQ(events[next].ray, block->first_ray + ray);
            ASSERT_EQ(events[next].step, block->steps.steps[s]) << "ray " << events[next].ray;
          }
          ASSERT_TRUE(events[next].is_return);
          ASSERT_EQ(events[next++].step.ref, block->expected[ray].primitive);
        }
        EXPECT_EQ(packets_walked, block->packets.visits.size());
      }
      EXPECT_EQ(next, events.size());
      const auto recorded = world.counts();
      EXPECT_EQ(result.counts.node_visits, recorded.node_visits);
      EXPECT_EQ(result.counts.triangle_tests, recorded.triangle_tests);
      EXPECT_EQ(result.counts.dropped, recorded.dropped);
    }
}

TEST(PacketCull, no_timing_changes_what_a_ray_or_a_packet_visits_and_exec_takes_the_cycles_of_replay) {
  for (const Case& c : kCases) {
    World& world = world_of(c);
    const std::uint64_t untimed_hash = run(world, world.config()).untimed_hash;
    int number = 0;
    for (const UnitConfig& config : timing_configs(world)) {
      SCOPED_TRACE(name_of(c) + ", config " + std::to_string(number++));
      const Outcome replay = run(world, config), exec = run(world, config, {.exec = true});
      expect_same_answers(world, replay, untimed_hash);
      expect_same_answers(world, exec, untimed_hash);
      expect_equal(replay.result, exec.result);
    }
  }
}

TEST(PacketCull, the_order_of_the_stages_and_skipping_idle_cycles_change_no_cycle) {
  for (const Case& c : kCases) {
    World& world = world_of(c);
    int number = 0;
    for (const UnitConfig& config : timing_configs(world)) {
      SCOPED_TRACE(name_of(c) + ", config " + std::to_string(number++));
      const UnitResult forward = world.run(config);
      expect_equal(forward, world.run(config, {.skip_idle = false, .reverse_order = true}));
      expect_equal(forward, world.run(config, {.skip_idle = false}));
    }
  }
}

TEST(PacketCull, links_that_refuse_at_random_change_no_answer) {
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
      expect_equal(backward.result, outcome.result);
    }
  }
}

TEST(PacketCull, all_modes_end_on_the_same_cycle_with_the_same_events_and_accounts) {
  for (const Case& c : kCases) {
    World& world = world_of(c);
    const auto configs = timing_configs(world);
    for (const std::size_t i : {0, 3, 6})
      for (const std::uint64_t stall_seed : {0, 77}) {
        const auto run_in = [&](unit::Mode mode) {
          VectorFeed feed(world.blocks(), c.packets);
          return unit::run(configs[i], {world.image(), world.tester(), feed}, {.mode = mode, .stall_seed = stall_seed});
        };
        const UnitResult plain = run_in(unit::Mode::Plain);
        EXPECT_EQ(plain.wrong_hits, 0u);
        for (const unit::Mode mode : {unit::Mode::Batch, unit::Mode::Cycle, unit::Mode::Pins}) {
          SCOPED_TRACE(name_of(c) + ", config " + std::to_string(i) + ", mode " +
                       std::to_string(static_cast<int>(mode)) + ", stall seed " + std::to_string(stall_seed));
          expect_equal(plain, run_in(mode));
        }
      }
  }
}

TEST(PacketCull, exec_needs_no_recorded_steps) {
  World& world = world_of(kCases[1]);
  const UnitResult with = world.run(world.config(), {.exec = true});
  World bare = World(world.tree(), Design::Projection, bundles(world.tree(), 230, 16));
  bare.travel_in(kCases[1].packets);
  bare.forget_steps();
  EXPECT_EQ(bare.run(bare.config(), {.exec = true}).event_log_hash, with.event_log_hash);
  EXPECT_THROW(bare.run(bare.config()), Error);
}

TEST(PacketCull, every_cycle_of_the_stage_and_of_each_ray_is_accounted_for) {
  for (const Case& c : kCases) {
    World& world = world_of(c);
    for (const UnitConfig& config : timing_configs(world)) {
      const UnitResult result = world.run(config);
      bool found = false;
      for (const pipeline::StageAccount& stage : result.stages) {
        std::uint64_t sum = stage.busy + stage.idle;
        for (const pipeline::Cause& cause : stage.stalled) sum += cause.cycles;
        EXPECT_EQ(sum, result.cycles) << stage.stage;
        found |= stage.stage == "packet_cull";
      }
      EXPECT_TRUE(found);
      std::uint64_t sum = 0;
      for (const pipeline::Cause& cause : result.ray_cycles) sum += cause.cycles;
      EXPECT_EQ(sum, result.ray_latency_sum);
    }
  }
}

TEST(PacketCull, counters_are_those_of_the_recording) {
  World& world = world_of(kCases[0]);
  std::uint64_t visits = 0, entries = 0, packets = 0, spared = 0, rays = 0;
  for (const auto& block : world.blocks()) {
    visits += block->packets.visits.size();
    entries += block->packets.entries.size();
    packets += block->packets.packets();
    spared = std::accumulate(block->steps.spared.begin(), block->steps.spared.end(), spared);
    for (const intersect::Ray& ray : block->rays) rays += intersect::is_valid(ray);
  }
  const UnitResult result = world.run(world.config());
  EXPECT_EQ(counter(result, "packets.packets"), packets);
  EXPECT_EQ(counter(result, "packets.rays"), rays);
  EXPECT_EQ(counter(result, "packets.node_visits"), visits);
  EXPECT_EQ(counter(result, "packets.entries"), entries);
  EXPECT_EQ(counter(result, "packets.node_tests_saved"), spared);
  EXPECT_GT(spared, visits);  // or the rays would not be worth a packet
  EXPECT_GT(counter(result, "packets.children_dropped"), 0u);
  EXPECT_LE(counter(result, "packets.most_under_way"), 8u);
}

TEST(PacketCull, rays_that_travel_alone_have_no_stage_no_link_and_no_counter_of_packets) {
  World world("gen:tilted-quads?quads=100", Design::None, 50);
  const UnitResult result = world.run(world.config());
  for (const pipeline::StageAccount& stage : result.stages) EXPECT_NE(stage.stage, "packet_cull");
  for (const pipeline::Counter& counter : result.counters) EXPECT_FALSE(counter.name.starts_with("packets."));
  UnitConfig other = world.config();
  other.packet_cull = {.packets = 1, .latency = 77, .interval = 9};
  EXPECT_EQ(world.run(other).event_log_hash, result.event_log_hash);
}

/// Four equal rays through one node with one leaf, warm enough to say when each thing happens.
TEST(PacketCull, a_lonely_packet_takes_the_cycles_that_the_timing_diagram_says) {
  for (const int latency : {1, 12, 30})
    for (const int interval : {1, 4, 11}) {
      World world(stacked_leaves(2, 1), Design::None, std::vector<intersect::Ray>(4, ray_through_leaves()));
      UnitConfig config = world.config();
      config.packet_cull.latency = latency, config.packet_cull.interval = interval;
      config.memory.model = pipeline::MemoryModel::Ideal;
      const UnitResult alone = world.run(config);
      world.travel_in({4, 1});
      const auto engine = world.engine(config, {.keep_events = true});
      pipeline::run_to_end(*engine);
      // The last ray leaves ray_queue with the setup's latency behind its entrance, and joins a cycle later. The root
      // is asked for in the cycle behind that and issued two cycles later; its lines come from memory.
      const pipeline::Cycle joined = static_cast<pipeline::Cycle>(
          3 * config.ray_setup.interval + config.ray_setup.interval - 1 + config.ray_setup.latency + 1);
      const pipeline::Cycle asked = joined + 1, issued = asked + 2, taken_by_fetch = issued + 1;
      const auto events = engine->log().events();
      const auto first = std::min_element(events.begin(), events.end(),
                                          [](const auto& a, const auto& b) { return a.cycle < b.cycle; });
      ASSERT_TRUE(is_packets(*first));
      // Ideal memory: as many cycles as the lonely ray's node fetch takes, which begins when its own root is asked for.
      const pipeline::Cycle alone_taken_by_fetch =
          static_cast<pipeline::Cycle>(config.ray_setup.interval - 1 + config.ray_setup.latency + 1 + 1 + 1);
      World lone(stacked_leaves(2, 1), Design::None, {ray_through_leaves()});
      const auto lone_engine = lone.engine(config, {.keep_events = true});
      pipeline::run_to_end(*lone_engine);
      const pipeline::Cycle box_tested = lone_engine->log().events().front().cycle;
      const auto fetch = box_tested - alone_taken_by_fetch - static_cast<pipeline::Cycle>(config.box_test.latency) - 1 -
                         static_cast<pipeline::Cycle>(config.child_sort.latency) - 1;
      EXPECT_EQ(first->cycle, taken_by_fetch + fetch + static_cast<pipeline::Cycle>(interval) - 1 +
                                  static_cast<pipeline::Cycle>(latency))
          << "latency " << latency << ", interval " << interval;
      EXPECT_GT(alone.cycles, 0u);
    }
}

TEST(PacketCull, fewer_contexts_than_a_packet_has_rays_are_refused) {
  World& world = world_of(kCases[1]);
  UnitConfig config = world.config();
  config.unit.contexts = 16;
  EXPECT_EQ(world.run(config).wrong_hits, 0u);
  config.unit.contexts = 15;
  try {
    world.run(config);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "unit.contexts");
    EXPECT_NE(std::string(error.what()).find("packets of 16 rays"), std::string::npos) << error.what();
  }
}

TEST(PacketCull, a_recorded_walk_of_another_packet_is_refused_with_its_first_ray) {
  World& world = world_of(kCases[0]);
  auto block = std::make_shared<reference::RayBlock>(*world.blocks()[0]);
  block->packets.visits[block->packets.first_visit[2]].node = 1;
  const std::vector<std::shared_ptr<const reference::RayBlock>> blocks{block};
  VectorFeed feed(blocks, kCases[0].packets);
  const auto engine = pipeline::make_engine(world.config(), {world.image(), world.tester(), feed}, {});
  try {
    pipeline::run_to_end(*engine);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "ray 16, visit 0");
  }
}

TEST(PacketCull, blocks_whose_packets_are_not_those_of_the_feed_are_refused) {
  World& world = world_of(kCases[0]);
  const auto expect_refused = [&](const reference::PacketList& packets) {
    auto block = std::make_shared<reference::RayBlock>(*world.blocks()[0]);
    block->packets = packets;
    const std::vector<std::shared_ptr<const reference::RayBlock>> blocks{block};
    VectorFeed feed(blocks, kCases[0].packets);
    EXPECT_THROW(pipeline::make_engine(world.config(), {world.image(), world.tester(), feed}, {.exec = true}), Error);
  };
  const auto rays = static_cast<std::uint32_t>(world.blocks()[0]->rays.size());
  expect_refused({});
  expect_refused(reference::cut_packets(rays - 1, 8));
  expect_refused(reference::cut_packets(rays, 9));
}

TEST(PacketCull, a_stuck_link_is_found_and_named) {
  World& world = world_of(kCases[0]);
  UnitConfig config = world.config();
  config.watchdog.cycles = 3000;
  for (int number = 0; number < 24; ++number) {
    try {
      world.run(config, {.backpressure = {.stuck_link = number}});
    } catch (const pipeline::DeadlockFound& deadlock) {
      EXPECT_NE(std::string(deadlock.what()).find("refuses although it has room"), std::string::npos);
      EXPECT_NE(std::string(deadlock.what()).find("packet_cull"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace ctu::test
