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
#include "sim/ladder/chunk_feed.h"
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
    options.rays.count = 32768;
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

  struct Windows {
    std::vector<ladder::Window> chunks;
    ladder::Window all;  ///< the sum, and the unit's way to its end
  };
  static Windows windows_of(const Unit& unit, const ladder::ChunkPlan& plan, const ladder::WarmUp& warm_up) {
    ladder::ChunkFeed feed(unit.work, plan, warm_up);
    pipeline::EngineOptions options;
    options.keep_events = true;
    const auto engine = pipeline::make_engine(unit.config, {unit.image, unit.tester, feed}, options);
    feed.run(*engine);
    Windows windows{feed.windows(), feed.drain()};
    for (const ladder::Window& window : windows.chunks) {
      windows.all.cycles += window.cycles;
      windows.all.node_visits += window.node_visits;
      windows.all.leaf_visits += window.leaf_visits;
    }
    return windows;
  }

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
  const Unit first(small_unit()), other_design(small_unit({"mask_test.design=none"})),
      slower(small_unit({"box_test.latency=24"}));
  constexpr std::uint64_t seed = 1;  // and those behind it: a rate of 200 trials is chance, which no run should be
  RecordProperty("seed", std::to_string(seed));
  ladder::SampledOptions options;
  options.error = 1;
  constexpr int kPairs = 8;
  int covered = 0;
  double width = 0, width_alone = 0;
  for (const Unit* second : {&other_design, &slower}) {
    const double truth = cycles(second->config) / cycles(first.config);
    for (int i = 0; i < kPairs; ++i) {
      options.seed = seed + static_cast<std::uint64_t>(i);
      const ladder::Comparison c = ladder::compare_sampled({first.work, first.image, first.config},
                                                           {second->work, second->image, second->config}, options);
      EXPECT_GT(c.ratio.half_width, 0) << "run whole";
      covered += std::abs(c.ratio.value - truth) <= c.ratio.half_width;
      if (i >= 4 || second != &slower) continue;
      width += c.ratio.half_width / c.ratio.value;
      const ladder::Sampled alone = ladder::run_sampled(first.work, first.image, first.config, options);
      width_alone += 0.5 * (alone.cycles_high - alone.cycles_low) / static_cast<double>(alone.result.cycles);
    }
  }
  EXPECT_LT(width, 0.7 * width_alone) << "where only times differ, the chunks of both are long for the same reasons";
  EXPECT_GE(covered, 0.79 * 2 * kPairs) << "seed " << seed;  // 95 %, less three standard deviations of 16 trials
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

TEST_F(SampledTest, every_ray_is_drawn_as_often_as_any_other_and_the_ends_always) {
  const Unit unit(small_unit());
  const std::uint64_t rays = trace_->reader().rays();
  constexpr unsigned seed = 7;
  std::mt19937_64 random(seed);
  constexpr int kPlans = 400;
  const ladder::ChunkSizes sizes{.measured = 48, .head = 96, .tail = 48};  // no divisor of a block
  for (const std::uint64_t wanted : {20u, 150u}) {
    std::vector<int> drawn(rays);
    double share = 0;
    for (int p = 0; p < kPlans; ++p) {
      const ladder::ChunkPlan plan = ladder::plan_chunks(unit.work, wanted, sizes, random);
      share = plan.share_of_blocks * plan.share_of_cells;
      std::uint64_t before = 0;
      for (const ladder::Chunk& chunk : plan.chunks) {
        ASSERT_GE(chunk.first, before);
        before = chunk.last;
        if (chunk.drawn) EXPECT_EQ(trace_->reader().block_of(chunk.last - 1), trace_->reader().block_of(chunk.first));
        for (std::uint64_t ray = chunk.first; ray < chunk.last; ++ray) ++drawn[ray];
      }
    }
    // Six standard deviations: there are as many cells as 340.
    const double doubt = 6 * std::sqrt(kPlans * share * (1 - share));
    for (std::uint64_t ray = 0; ray < rays; ++ray)
      if (ray < sizes.head || ray >= rays - sizes.tail)
        ASSERT_EQ(drawn[ray], kPlans) << ray;
      else
        ASSERT_NEAR(drawn[ray], kPlans * share, doubt) << ray << " of seed " << seed;
  }
}

/// Nothing lies between chunks, so the unit never waits and the sum of all windows is the run.
TEST_F(SampledTest, chunks_without_gaps_are_the_run_of_all_rays) {
  const Unit unit(small_unit());
  std::mt19937_64 random(1);
  const ladder::ChunkPlan plan =
      ladder::plan_chunks(unit.work, trace_->reader().rays(), {.measured = 48, .head = 96, .tail = 48}, random);
  const Windows run = windows_of(unit, plan, {.simulated_rays = 8, .shown_visits = 1000, .most_shown_rays = 100});
  EXPECT_EQ(run.all.cycles, cycles(unit.config));
  const auto& counts = trace_->reader().manifest().find(cull::Design::MaskLut)->counts;
  EXPECT_EQ(run.all.node_visits, static_cast<double>(counts.node_visits));
  EXPECT_EQ(run.all.leaf_visits, static_cast<double>(counts.leaf_visits));
}

/// The same chunks in the run of all rays, and behind gaps with and without what is done about them.
TEST_F(SampledTest, a_chunk_behind_a_gap_takes_what_it_takes_in_the_run_of_all_rays) {
  const Unit unit(small_unit());
  constexpr std::uint64_t kLength = 64;
  ladder::ChunkPlan all, some;
  std::vector<std::size_t> places;
  for (std::uint64_t ray = 0; ray < trace_->reader().rays(); ray += kLength) {
    if (all.chunks.size() % 8 == 7) {
      places.push_back(all.chunks.size());
      some.chunks.push_back({ray, ray + kLength});
    }
    all.chunks.push_back({ray, ray + kLength});
  }
  const Windows truth = windows_of(unit, all, {});
  double expected = 0;
  for (const std::size_t place : places) expected += truth.chunks[place].cycles;
  const auto off = [&](const ladder::WarmUp& warm_up) {
    double taken = 0;
    for (const ladder::Window& window : windows_of(unit, some, warm_up).chunks) taken += window.cycles;
    return taken / expected - 1;
  };
  EXPECT_GT(off({}), 0.01) << "the chunk before is still at work, and caches are as it has left them";
  const ladder::WarmUp warm_up{.contexts = 4,
                               .simulated_rays = 12,
                               .simulated_work = 512,
                               .most_simulated_rays = 64,
                               .shown_visits = 1536,
                               .most_shown_rays = 384};
  EXPECT_NEAR(off(warm_up), 0, 0.005);
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
