// All executions of the unit end on the same cycle with the same event log, and draw the same waves.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "model/accel/build.h"
#include "model/scene/load.h"
#include "model/unit/run.h"
#include "tests/pipeline/world.h"

namespace ctu::test {
namespace {

using cull::Design;
using unit::Mode;

constexpr Mode kModes[] = {Mode::Plain, Mode::Batch, Mode::Cycle, Mode::Pins};
constexpr const char* kModeNames[] = {"plain", "batch", "cycle", "pins"};

pipeline::UnitResult run(const World& world, const pipeline::UnitConfig& config, const unit::RunOptions& options) {
  VectorFeed feed(world.blocks());
  return unit::run(config, {world.image(), world.tester(), feed}, options);
}

void expect_equal(const pipeline::UnitResult& a, const pipeline::UnitResult& b) {
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_EQ(a.event_log_hash, b.event_log_hash);
  EXPECT_EQ(a.wrong_hits, 0u);
  EXPECT_EQ(b.wrong_hits, 0u);
  EXPECT_EQ(a.rays, b.rays);
  EXPECT_EQ(a.ray_latency_sum, b.ray_latency_sum);
  ASSERT_EQ(a.counters.size(), b.counters.size());
  for (std::size_t i = 0; i < a.counters.size(); ++i)
    EXPECT_EQ(a.counters[i].value, b.counters[i].value) << a.counters[i].name;
  ASSERT_EQ(a.stages.size(), b.stages.size());
  for (std::size_t i = 0; i < a.stages.size(); ++i) {
    EXPECT_EQ(a.stages[i].busy, b.stages[i].busy) << a.stages[i].stage;
    EXPECT_EQ(a.stages[i].idle, b.stages[i].idle) << a.stages[i].stage;
    for (std::size_t c = 0; c < a.stages[i].stalled.size(); ++c)
      EXPECT_EQ(a.stages[i].stalled[c].cycles, b.stages[i].stalled[c].cycles) << a.stages[i].stage;
  }
}

std::vector<pipeline::UnitConfig> configs_of(const World& world) {
  std::vector<pipeline::UnitConfig> configs(4, world.config());
  configs[1].unit.contexts = 5;
  configs[1].unit.batch_cycles = 7;
  configs[1].memory.model = pipeline::MemoryModel::Ideal;
  configs[1].scheduler.policy = pipeline::SchedulerPolicy::RoundRobin;
  configs[2].stack = {.entries = 1, .push_width = 1, .spill_batch = 1};
  configs[2].unit.batch_cycles = 1;
  configs[2].node_cache.bytes = 2048;
  configs[2].mask_test.banks = 1;
  configs[3].table_cache = {.bytes = 2048, .ways = 2, .hit_latency = 4, .ports = 1, .mshrs = 3};
  return configs;
}

TEST(Modes, all_end_on_the_same_cycle_with_the_same_events_and_accounts) {
  for (const Design design :
       {Design::None, Design::MaskLut, Design::BitTable, Design::Dedup, Design::Projection, Design::Comparators}) {
    const std::uint32_t box_bits = design == Design::MaskLut ? 8 : design == Design::Comparators ? 12 : 32;
    scene::Mesh mesh = scene::load("gen:hair-ball?strands=80").mesh;
    const bool spheres = design == Design::Dedup, primitive_boxes = spheres || design == Design::None;
    if (spheres) test::add_spheres(mesh);
    const World world(accel::build(mesh, {.triangle_cost = primitive_boxes ? 0.01f : 1.0f}), design, 150,
                      {.entries = design == Design::BitTable ? 32 : 0}, box_bits, primitive_boxes);
    for (const auto& config : configs_of(world))
      for (const auto source : {unit::Source::Replay, unit::Source::Exec})
        for (const std::uint64_t stall_seed : {0, 77}) {
          const auto plain = run(world, config, {.mode = Mode::Plain, .source = source, .stall_seed = stall_seed});
          for (int mode = 1; mode < 4; ++mode) {
            SCOPED_TRACE(std::string(cull::to_string(design)) + ", " + kModeNames[mode] + ", stall seed " +
                         std::to_string(stall_seed));
            expect_equal(plain, run(world, config, {.mode = kModes[mode], .source = source, .stall_seed = stall_seed}));
          }
        }
  }
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Waves, are_the_same_in_all_modes_and_change_no_cycle) {
  const World world("gen:tilted-quads?quads=100", Design::Projection, 30);
  const auto unwatched = run(world, world.config(), {});
  std::string first;
  for (int mode = 0; mode < 4; ++mode) {
    SCOPED_TRACE(kModeNames[mode]);
    const std::string path = testing::TempDir() + "ctu_modes_test_" + kModeNames[mode] + ".vcd";
    const auto result =
        run(world, world.config(), {.mode = kModes[mode], .waves_path = path, .waves_first = 20, .waves_last = 700});
    EXPECT_EQ(result.cycles, unwatched.cycles);
    const std::string waves = text_of(path);
    std::remove(path.c_str());
    EXPECT_NE(waves.find("$enddefinitions"), std::string::npos);
    EXPECT_NE(waves.find("\n#20\n"), std::string::npos);
    EXPECT_EQ(waves.find("\n#701\n"), std::string::npos);
    if (mode == 0) first = waves;
    EXPECT_TRUE(waves == first);
  }
}

TEST(Deadlock, is_thrown_in_every_mode_at_the_same_cycle_with_the_same_report) {
  const World world("gen:tilted-quads?quads=100", Design::None, 30);
  pipeline::UnitConfig config = world.config();
  config.watchdog.cycles = 1000;
  std::string first;
  for (int mode = 0; mode < 4; ++mode) {
    SCOPED_TRACE(kModeNames[mode]);
    try {
      run(world, config, {.mode = kModes[mode], .stuck_link = 5});
      FAIL() << "ended";
    } catch (const unit::Deadlock& deadlock) {
      if (mode == 0) first = deadlock.what();
      EXPECT_EQ(deadlock.what(), first);
      EXPECT_NE(first.find("node_to_box"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace ctu::test
