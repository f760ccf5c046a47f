// The closed forms beside the timed unit on the same rays: what they count is equal, what they compute is near.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "model/base/error.h"
#include "sim/config_file.h"
#include "sim/ladder/estimate.h"
#include "sim/loaded_trace.h"
#include "sim/unit_runner.h"

namespace {

using namespace ctu;
using Sets = std::vector<std::string>;

class EstimateTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { trace_ = new sim::LoadedTrace(std::string(CTU_TEST_DATA) + "/hair-ball.ctut"); }
  static void TearDownTestSuite() { delete trace_; }

  static pipeline::UnitResult cycle(const pipeline::UnitConfig& config) {
    sim::RunPlan plan;
    plan.config = config;
    plan.range = trace_->range(0, 0);
    return sim::run_plan(*trace_, plan).result;
  }
  static ladder::VisitProfile profile(const pipeline::UnitConfig& config) {
    const cull::MaskTester tester = trace_->tester(config.mask_test.design);
    return ladder::profile_of(work(tester), trace_->unit_image(config.mask_test.design), config);
  }
  static ladder::Estimate estimate(const pipeline::UnitConfig& config) {
    const cull::MaskTester tester = trace_->tester(config.mask_test.design);
    return ladder::estimate(work(tester), profile(config), config);
  }
  static ladder::TraceWork work(const cull::MaskTester& tester) {
    return {trace_->reader(), trace_->bvh(), &trace_->masks(), tester, trace_->range(0, 0)};
  }
  static std::uint64_t counter(const pipeline::UnitResult& result, const std::string& name) {
    for (const auto& counter : result.counters)
      if (counter.name == name) return counter.value;
    ADD_FAILURE() << "no counter " << name;
    return 0;
  }

  static const sim::LoadedTrace* trace_;
};
const sim::LoadedTrace* EstimateTest::trace_ = nullptr;

const std::vector<Sets> kConfigs = {
    {},
    {"mask_test.design=none"},
    {"mask_test.design=mask-lut"},
    {"mask_test.design=comparators"},
    {"mask_test.design=dedup", "mask_test.rows=folded"},
    {"unit.contexts=4"},
    {"unit.contexts=128"},
    {"node_cache.bytes=8192", "leaf_cache.bytes=8192"},
    {"node_cache.mshrs=2", "leaf_cache.mshrs=2"},
    {"memory.channels=1", "memory.t_cl=100"},
    {"memory.model=ideal", "memory.latency=400", "memory.interval=16"},
    {"memory.front_latency=1000"},
    {"memory.line_bytes=64"},
    {"stack.entries=2", "stack.spill_batch=2"},
    {"triangle_test.interval=30"},
    {"ray_setup.interval=40"},
    {"mask_test.banks=1", "mask_test.projection_tables=1"},
    {"table_cache.bytes=2048"},
    {"box_test.latency=60", "child_sort.latency=50"},
};

TEST_F(EstimateTest, cycles_lie_within_15_percent_of_the_timed_units) {
  for (const Sets& sets : kConfigs) {
    const pipeline::UnitConfig config = sim::load_config("", sets);
    const auto truth = static_cast<double>(cycle(config).cycles);
    const auto estimated = static_cast<double>(estimate(config).result.cycles);
    EXPECT_NEAR(estimated / truth, 1, 0.15) << (sets.empty() ? "default" : sets[0]);
  }
}

TEST_F(EstimateTest, what_rays_do_is_counted_as_the_timed_unit_counts_it) {
  for (const Sets& sets : kConfigs) {
    const pipeline::UnitConfig config = sim::load_config("", sets);
    const pipeline::UnitResult truth = cycle(config), estimated = estimate(config).result;
    const std::string name = sets.empty() ? "default" : sets[0];
    EXPECT_EQ(estimated.rays, truth.rays) << name;
    EXPECT_EQ(estimated.counts.node_visits, truth.counts.node_visits) << name;
    EXPECT_EQ(estimated.counts.triangle_tests, truth.counts.triangle_tests) << name;
    EXPECT_EQ(estimated.counts.culled, truth.counts.culled) << name;
    for (const char* same : {"stack.pushes", "stack.pops", "stack.deepest", "stack.spills", "stack.refills",
                             "node_fetch.lookups", "node_fetch.bytes", "leaf_fetch.lookups", "leaf_fetch.bytes"})
      EXPECT_EQ(counter(estimated, same), counter(truth, same)) << name << ": " << same;
    if (config.mask_test.design == cull::Design::None) continue;
    for (const char* same : {"cell_locate.lanes", "mask_test.lanes_unasked", "mask_test.reads", "mask_test.rows_used",
                             "mask_test.table_bits"})
      EXPECT_EQ(counter(estimated, same), counter(truth, same)) << name << ": " << same;
  }
}

TEST_F(EstimateTest, counts_of_a_part_of_the_trace_are_its_own) {
  const pipeline::UnitConfig config;
  sim::RunPlan plan;
  plan.config = config;
  plan.range = trace_->range(500, 700);
  const pipeline::UnitResult truth = sim::run_plan(*trace_, plan).result;
  const cull::MaskTester tester = trace_->tester(config.mask_test.design);
  ladder::TraceWork part = work(tester);
  part.range = plan.range;
  const auto counted = ladder::profile_of(part, trace_->unit_image(config.mask_test.design), config);
  const pipeline::UnitResult estimated = ladder::estimate(part, counted, config).result;
  EXPECT_EQ(estimated.rays, 700u);
  EXPECT_EQ(estimated.counts.node_visits, truth.counts.node_visits);
  EXPECT_EQ(estimated.counts.leaf_visits, truth.counts.leaf_visits);
}

TEST_F(EstimateTest, one_ray_at_a_time_misses_what_a_fully_associative_cache_misses) {
  // One set, and one ray under way: nothing is left to chance but the order of the two lines of a node.
  for (const int lines : {8, 16}) {
    const pipeline::UnitConfig config =
        sim::load_config("", {"unit.contexts=1", "node_cache.ways=" + std::to_string(lines),
                              "node_cache.bytes=" + std::to_string(lines * 128)});
    const auto truth = static_cast<double>(counter(cycle(config), "node_fetch.fills"));
    EXPECT_NEAR(static_cast<double>(counter(estimate(config).result, "node_fetch.fills")) / truth, 1, 0.03) << lines;
  }
}

TEST_F(EstimateTest, every_parameter_of_time_has_its_effect) {
  const double base = static_cast<double>(estimate({}).result.cycles);
  const std::vector<Sets> slower = {{"ray_setup.latency=100"},
                                    {"ray_setup.interval=50"},
                                    {"node_cache.bytes=1024", "node_cache.ways=1"},
                                    {"node_cache.hit_latency=30"},
                                    {"node_cache.mshrs=1"},
                                    {"leaf_cache.hit_latency=100"},
                                    {"leaf_cache.bytes=0"},
                                    {"leaf_cache.mshrs=1"},
                                    {"memory.front_latency=300"},
                                    {"memory.channels=1", "memory.burst=64"},
                                    {"memory.banks=1", "memory.t_ras=400"},
                                    {"memory.t_cl=80"},
                                    {"memory.t_rcd=80"},
                                    {"memory.t_rp=80"},
                                    {"memory.t_rfc=2000"},
                                    {"box_test.latency=50"},
                                    {"cell_locate.latency=50"},
                                    {"mask_test.latency=50"},
                                    {"mask_test.banks=1", "mask_test.projection_tables=1"},
                                    {"child_sort.latency=50"},
                                    {"stack.entries=1", "stack.spill_batch=1"},
                                    {"triangle_test.latency=100"},
                                    {"triangle_test.interval=60"},
                                    {"hit_update.latency=100"},
                                    {"result.interval=40"},
                                    {"unit.contexts=8"},
                                    {"table_cache.bytes=512", "table_cache.ways=1"}};
  for (const Sets& sets : slower)
    EXPECT_GT(static_cast<double>(estimate(sim::load_config("", sets)).result.cycles), 1.002 * base) << sets[0];
}

TEST_F(EstimateTest, stages_add_up_and_the_limit_is_named) {
  const ladder::Estimate free = estimate({});
  for (const auto& stage : free.result.stages) EXPECT_EQ(stage.busy + stage.idle, free.result.cycles) << stage.stage;
  EXPECT_EQ(free.limit, "contexts");
  EXPECT_EQ(estimate(sim::load_config("", {"triangle_test.interval=60"})).limit, "triangle_test");
  EXPECT_EQ(estimate(sim::load_config("", {"ray_setup.interval=50"})).limit, "ray_queue");
}

TEST_F(EstimateTest, a_kept_profile_gives_the_same_answer_and_a_broken_file_none) {
  const auto folder = std::filesystem::temp_directory_path() / ("ctusim-profiles-" + std::to_string(::getpid()));
  const ladder::ProfileStore store(folder);
  const pipeline::UnitConfig config;
  const cull::MaskTester tester = trace_->tester(config.mask_test.design);
  const std::string name = ladder::profile_name(work(tester), config);
  EXPECT_FALSE(store.find(name).has_value());
  store.keep(name, profile(config));
  const auto kept = store.find(name);
  ASSERT_TRUE(kept.has_value());
  EXPECT_EQ(ladder::estimate(work(tester), *kept, config).result.cycles, estimate(config).result.cycles);
  EXPECT_FALSE(store.find(name + " ").has_value());

  const auto file = std::filesystem::directory_iterator(folder)->path();
  const auto bytes = std::filesystem::file_size(file);
  {
    std::fstream damage(file, std::ios::in | std::ios::out | std::ios::binary);
    damage.seekp(static_cast<std::streamoff>(bytes / 2));
    damage.put('!');
    damage.put('?');
  }
  EXPECT_FALSE(store.find(name).has_value());
  std::filesystem::resize_file(file, bytes / 3);
  EXPECT_FALSE(store.find(name).has_value());
  std::filesystem::remove_all(folder);
}

TEST_F(EstimateTest, a_configuration_that_cannot_be_is_refused) {
  pipeline::UnitConfig config;
  config.node_cache.bytes = 100;
  EXPECT_THROW(estimate(config), Error);
}

}  // namespace
