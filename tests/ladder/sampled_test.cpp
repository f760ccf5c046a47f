// Samples against the run of all rays: intervals that cover it, plans that lie where they say, what is refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <random>

#include "model/base/error.h"
#include "model/scene/load.h"
#include "sim/config_file.h"
#include "sim/ladder/chunk_plan.h"
#include "sim/ladder/sampled.h"
#include "sim/loaded_trace.h"
#include "sim/unit_runner.h"
#include "traces/recorder.h"

namespace {

using namespace ctu;

class SampledTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    path_ = std::filesystem::temp_directory_path() / ("ctusim-sampled-" + std::to_string(::getpid()) + ".ctut");
    traces::RecordOptions options;
    options.rays.kind = traces::RayOptions::Rays::Random;
    options.rays.count = 16384;
    options.rays_per_block = 1024;
    options.designs = {cull::Design::None, cull::Design::MaskLut};
    traces::record(scene::load("gen:hair-ball?strands=40&segments=3&seed=5"), options, path_.string());
    trace_ = new sim::LoadedTrace(path_.string());
  }
  static void TearDownTestSuite() {
    delete trace_;
    std::filesystem::remove(path_);
  }

  /// Few contexts and small caches, so that chunks are short and many repetitions cheap.
  static pipeline::UnitConfig small_unit(const std::vector<std::string>& more = {}) {
    std::vector<std::string> sets = {"unit.contexts=4", "node_cache.bytes=8192", "leaf_cache.bytes=4096"};
    sets.insert(sets.end(), more.begin(), more.end());
    return sim::load_config("", sets);
  }
  static double cycles(const pipeline::UnitConfig& config) {
    sim::RunPlan plan;
    plan.config = config;
    plan.range = trace_->range(0, 0);
    return static_cast<double>(sim::run_plan(*trace_, plan).result.cycles);
  }

  /// A configuration with what it works on.
  struct Unit {
    explicit Unit(const pipeline::UnitConfig& config_)
        : config(config_),
          tester(trace_->tester(config.mask_test.design)),
          image(trace_->unit_image(config.mask_test.design)),
          work{trace_->reader(), trace_->bvh(), &trace_->masks(), tester, trace_->range(0, 0)} {}
    pipeline::UnitConfig config;
    cull::MaskTester tester;
    accel::Image image;
    ladder::TraceWork work;
  };

  static std::filesystem::path path_;
  static const sim::LoadedTrace* trace_;
};
std::filesystem::path SampledTest::path_;
const sim::LoadedTrace* SampledTest::trace_ = nullptr;

constexpr int kRepetitions = 200;

TEST_F(SampledTest, intervals_cover_the_cycles_of_the_whole_run_at_their_stated_rate) {
  const Unit unit(small_unit());
  const double truth = cycles(unit.config);
  constexpr std::uint64_t seed = 1;  // and those behind it: a rate of 200 trials is chance, which no run should be
  RecordProperty("seed", std::to_string(seed));
  ladder::SampledOptions options;
  options.error = 1;  // one draw is enough
  int covered = 0;
  double bias = 0;
  for (int i = 0; i < kRepetitions; ++i) {
    options.seed = seed + static_cast<std::uint64_t>(i);
    const ladder::Sampled sampled = ladder::run_sampled(unit.work, unit.image, unit.config, options);
    ASSERT_FALSE(sampled.whole);
    covered += sampled.cycles_low <= truth && truth <= sampled.cycles_high;
    bias += static_cast<double>(sampled.result.cycles) / truth - 1;
  }
  // 95 %, less three standard deviations of 200 trials.
  EXPECT_GE(covered, 0.904 * kRepetitions) << "seed " << seed;
  EXPECT_NEAR(bias / kRepetitions, 0, 0.01) << "seed " << seed;
}

TEST_F(SampledTest, paired_chunks_say_how_two_units_differ) {
  const Unit first(small_unit()), second(small_unit({"mask_test.design=none"}));
  const double truth = cycles(second.config) / cycles(first.config);
  constexpr std::uint64_t seed = 1;  // and those behind it: a rate of 200 trials is chance, which no run should be
  RecordProperty("seed", std::to_string(seed));
  ladder::SampledOptions options;
  options.error = 1;
  constexpr int kPairs = 24;
  int covered = 0;
  double width = 0, width_alone = 0;
  for (int i = 0; i < kPairs; ++i) {
    options.seed = seed + static_cast<std::uint64_t>(i);
    const ladder::Comparison c = ladder::compare_sampled({first.work, first.image, first.config},
                                                         {second.work, second.image, second.config}, options);
    covered += std::abs(c.ratio.value - truth) <= c.ratio.half_width;
    if (i >= 4) continue;
    width += c.ratio.half_width / c.ratio.value;
    const ladder::Sampled alone = ladder::run_sampled(first.work, first.image, first.config, options);
    width_alone += 0.5 * (alone.cycles_high - alone.cycles_low) / static_cast<double>(alone.result.cycles);
  }
  EXPECT_LT(width, width_alone) << "two units on the same chunks are compared better than one is known";
  EXPECT_GE(covered, 0.81 * kPairs) << "seed " << seed;  // 95 %, less three standard deviations of 24 trials
}

TEST_F(SampledTest, an_error_asked_for_is_reached_and_a_seed_repeats_its_sample) {
  const Unit unit(small_unit());
  ladder::SampledOptions options;
  options.error = 0.05;
  const auto run = [&] { return ladder::run_sampled(unit.work, unit.image, unit.config, options); };
  const ladder::Sampled one = run(), again = run();
  EXPECT_EQ(one.result.cycles, again.result.cycles);
  EXPECT_EQ(one.cycles_low, again.cycles_low);
  EXPECT_FALSE(one.whole);
  EXPECT_LE(one.cycles_high - one.cycles_low, 2 * 0.0501 * static_cast<double>(one.result.cycles));
  options.seed = 2;
  EXPECT_NE(run().result.cycles, one.result.cycles);
}

TEST_F(SampledTest, where_nearly_all_rays_would_be_needed_all_are_run) {
  const Unit unit(small_unit());
  ladder::SampledOptions options;
  options.error = 0.0005;
  const ladder::Sampled sampled = ladder::run_sampled(unit.work, unit.image, unit.config, options);
  EXPECT_TRUE(sampled.whole);
  EXPECT_EQ(static_cast<double>(sampled.result.cycles), cycles(unit.config));
  EXPECT_EQ(sampled.cycles_low, sampled.cycles_high);
}

TEST_F(SampledTest, sums_are_of_the_whole_trace) {
  const Unit unit(small_unit());
  ladder::SampledOptions options;
  options.error = 1;
  const ladder::Sampled sampled = ladder::run_sampled(unit.work, unit.image, unit.config, options);
  const auto& counts = trace_->reader().manifest().find(cull::Design::MaskLut)->counts;
  EXPECT_EQ(sampled.result.rays, trace_->reader().rays());
  EXPECT_EQ(sampled.result.counts.node_visits, counts.node_visits);
  EXPECT_EQ(sampled.result.counts.culled, counts.culled);
  for (const auto& stage : sampled.result.stages) {
    std::uint64_t sum = stage.busy + stage.idle;
    for (const auto& cause : stage.stalled) sum += cause.cycles;
    EXPECT_NEAR(static_cast<double>(sum), static_cast<double>(sampled.result.cycles), 8) << stage.stage;
  }
}

TEST_F(SampledTest, chunks_lie_one_in_each_stretch_and_in_few_blocks_of_a_long_trace) {
  const Unit unit(small_unit());
  std::mt19937_64 random(7);
  const std::uint64_t rays = trace_->reader().rays(), blocks = trace_->reader().blocks();
  ASSERT_GT(blocks, 12u);
  const ladder::ChunkPlan many = ladder::plan_chunks(unit.work, 200, {16, 32, 64}, random);
  ASSERT_EQ(many.chunks.size(), 200u);
  EXPECT_EQ(many.units, 200u);
  for (std::size_t i = 0; i < many.chunks.size(); ++i) {
    const ladder::Chunk& chunk = many.chunks[i];
    EXPECT_GE(chunk.first, rays * i / 200);
    EXPECT_LE(chunk.last, rays * (i + 1) / 200);
    EXPECT_EQ(chunk.last - chunk.first, 32u);
    EXPECT_LE(chunk.warm, chunk.first);
    EXPECT_GE(chunk.warm, i == 0 ? 0 : many.chunks[i - 1].last);
  }
  const ladder::ChunkPlan few = ladder::plan_chunks(unit.work, 16, {16, 32, 64}, random);
  EXPECT_EQ(few.units, 2u);
  EXPECT_EQ(few.chunks.size(), 16u);
  for (const ladder::Chunk& chunk : few.chunks) {
    EXPECT_EQ(trace_->reader().block_of(chunk.warm), trace_->reader().block_of(few.chunks[chunk.unit * 8].first));
    EXPECT_EQ(trace_->reader().block_of(chunk.last - 1), trace_->reader().block_of(chunk.first));
  }
}

TEST_F(SampledTest, errors_and_confidences_out_of_range_are_refused) {
  for (const double error : {0.0, -1.0, 2.0, std::nan("")}) {
    ladder::SampledOptions options;
    options.error = error;
    EXPECT_THROW(ladder::require_possible(options), Error);
  }
  for (const double confidence : {0.0, 1.0, std::nan("")}) {
    ladder::SampledOptions options;
    options.confidence = confidence;
    EXPECT_THROW(ladder::require_possible(options), Error);
  }
}

}  // namespace
