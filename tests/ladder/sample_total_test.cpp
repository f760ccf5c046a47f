// Totals from samples, and their intervals, against tables and against populations whose total is known.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "sim/ladder/sample_total.h"
#include "sim/ladder/student.h"

namespace {

using namespace ctu::ladder;

TEST(student_t, is_that_of_the_tables) {
  // Abramowitz and Stegun, table 26.10.
  EXPECT_NEAR(student_t(0.95, 1), 12.706, 0.001);
  EXPECT_NEAR(student_t(0.95, 2), 4.303, 0.001);
  EXPECT_NEAR(student_t(0.95, 10), 2.228, 0.001);
  EXPECT_NEAR(student_t(0.99, 30), 2.750, 0.001);
  EXPECT_NEAR(student_t(0.90, 120), 1.658, 0.001);
  EXPECT_NEAR(student_t(0.95, 1e6), 1.960, 0.001);
}

Draw draw_of(const std::vector<Measure>& chunks, double share_of_groups, double share_within) {
  return {chunks, share_of_groups, share_within};
}

TEST(sample_total, of_values_that_sizes_say_is_exact) {
  std::vector<Measure> chunks;
  for (int i = 1; i < 20; ++i) {
    const double nodes = 10.0 + i * i % 7, leaves = i % 5;
    chunks.push_back({8 * 64 + 3 * nodes + 5 * leaves, {64, nodes, leaves}, static_cast<std::size_t>(i / 4)});
  }
  const std::vector<Draw> draws{draw_of(chunks, 0.1, 0.1)};
  const Total total = estimate_total(draws, {6400, 1500, 300}, 3);
  EXPECT_NEAR(total.value, 8 * 6400 + 3 * 1500 + 5 * 300, 1e-6);
  EXPECT_NEAR(half_width(draws, total, 0.95), 0, 1e-6);
}

TEST(sample_total, a_size_that_another_gives_has_no_part_and_none_known_leaves_the_mean) {
  const std::vector<Draw> draws{draw_of({{20, {2, 4, 0}, 0}, {34, {2, 4, 0}, 0}, {27, {2, 4, 0}, 1}}, 0.5, 0.5)};
  EXPECT_NEAR(estimate_total(draws, {20, 40, 0}, 3).value, 270, 1e-9);
  EXPECT_NEAR(estimate_total(draws, {20, 77, 9}, 1).value, 270, 1e-9);
}

/// All samples of five of nine chunks, whose sizes say little of their values: an estimator free of bias is right in
/// the mean of them.
TEST(sample_total, the_mean_over_all_samples_is_the_total) {
  const std::vector<Measure> population{{7, {1, 1, 0}, 0}, {2, {1, 2, 0}, 0}, {30, {1, 3, 0}, 0},
                                        {4, {1, 1, 0}, 0}, {9, {1, 2, 0}, 0}, {1, {1, 3, 0}, 0},
                                        {8, {1, 1, 0}, 0}, {5, {1, 2, 0}, 0}, {60, {1, 3, 0}, 0}};
  Sizes sizes{};
  double truth = 0, sum = 0;
  for (const Measure& m : population) {
    truth += m.value;
    for (std::size_t i = 0; i < kSizes; ++i) sizes[i] += m.sizes[i];
  }
  for (const std::size_t known : {1u, 2u}) {
    int samples = 0;
    sum = 0;
    for (unsigned drawn = 0; drawn < 1u << population.size(); ++drawn) {
      if (std::popcount(drawn) != 5) continue;
      std::vector<Measure> chunks;
      for (std::size_t i = 0; i < population.size(); ++i)
        if ((drawn >> i & 1) != 0) chunks.push_back(population[i]);
      sum += estimate_total({draw_of(chunks, 1, 5.0 / 9)}, sizes, known).value;
      ++samples;
    }
    EXPECT_EQ(samples, 126);
    EXPECT_NEAR(sum / samples, truth, 1e-9 * truth) << known;
  }
}

TEST(sample_total, of_the_whole_population_leaves_no_doubt) {
  const std::vector<Draw> draws{draw_of({{1, {2}, 0}, {5, {2}, 0}, {2, {3}, 1}}, 1, 1)};
  EXPECT_DOUBLE_EQ(half_width(draws, estimate_total(draws, {7}, 1), 0.95), 0);
}

TEST(sample_total, two_stages_add_what_groups_and_what_their_chunks_differ) {
  // Residuals by hand: groups {1, 3}, {2, 6}, {5, 5}; sums 4, 8, 10; a half of the groups, a quarter of their chunks.
  const std::vector<Draw> draws{
      draw_of({{0, {}, 0}, {0, {}, 0}, {0, {}, 1}, {0, {}, 1}, {0, {}, 2}, {0, {}, 2}}, 0.5, 0.25)};
  const Spread spread = spread_of_sum(draws, {{1, 3, 2, 6, 5, 5}});
  const double between = 3 * 0.5 * (16 + 4) / 4.0, within = 6 * 0.5 * 0.75 * (4 + 16 + 0) / 6.0;
  EXPECT_DOUBLE_EQ(spread.variance, between + within);
  EXPECT_NEAR(spread.freedom, spread.variance * spread.variance / (between * between / (4 / 3.0) + within * within / 2),
              1e-9);
}

/// A trace of blocks that change slowly and differ by chance, with chunks that do so too and are not normal.
struct Population {
  static constexpr std::size_t kBlocks = 120, kChunks = 30;
  std::vector<std::vector<Measure>> blocks;
  double total = 0;
  Sizes sizes{};

  explicit Population(std::mt19937& random) {
    std::gamma_distribution<double> size(2.0, 0.5), chance(2.0, 0.5);
    std::normal_distribution<double> block(0, 0.1);
    for (std::size_t b = 0; b < kBlocks; ++b) {
      std::vector<Measure>& chunks = blocks.emplace_back();
      const double level = 3 + std::sin(static_cast<double>(b) * 0.05) + block(random);
      for (std::size_t c = 0; c < kChunks; ++c) {
        const double visits = 1 + size(random);
        chunks.push_back({level + 2 * visits + 0.4 * chance(random) * visits, {1, visits, 0}, b});
        total += chunks.back().value;
        for (std::size_t i = 0; i < kSizes; ++i) sizes[i] += chunks.back().sizes[i];
      }
    }
  }
  /// One block of each `of_blocks`, and in it one chunk of each `of_chunks`.
  Draw draw(std::size_t of_blocks, std::size_t of_chunks, std::mt19937& random) const {
    Draw draw;
    draw.share_of_groups = 1.0 / static_cast<double>(of_blocks);
    draw.share_within = 1.0 / static_cast<double>(of_chunks);
    for (std::size_t b = 0; b < kBlocks; b += of_blocks) {
      const auto& chunks = blocks[b + random() % of_blocks];
      for (std::size_t c = 0; c < kChunks; c += of_chunks) draw.chunks.push_back(chunks[c + random() % of_chunks]);
    }
    return draw;
  }
};

TEST(sample_total, intervals_hold_the_truth_at_their_stated_rate) {
  const unsigned seed = std::random_device{}();
  RecordProperty("seed", std::to_string(seed));
  std::mt19937 random(seed);
  constexpr int kRepetitions = 1000;
  const Population population(random);
  struct Case {
    std::size_t of_blocks, of_chunks;
  };
  for (const Case c : {Case{1, 10}, Case{2, 6}, Case{5, 6}})
    for (const double confidence : {0.8, 0.95}) {
      int covered = 0;
      double bias = 0;
      for (int r = 0; r < kRepetitions; ++r) {
        const std::vector<Draw> draws{population.draw(c.of_blocks, c.of_chunks, random)};
        const Total total = estimate_total(draws, population.sizes, 3);
        covered += std::abs(total.value - population.total) <= half_width(draws, total, confidence);
        bias += total.value / population.total - 1;
      }
      // Four standard deviations of the count, and two points for what a sample of 24 blocks is off from normal.
      const double rate = static_cast<double>(covered) / kRepetitions;
      const double doubt = 4 * std::sqrt(confidence * (1 - confidence) / kRepetitions) + 0.02;
      EXPECT_NEAR(rate, confidence, doubt) << c.of_blocks << " seed " << seed;
      EXPECT_NEAR(bias / kRepetitions, 0, 0.002) << c.of_blocks << " seed " << seed;
    }
}

TEST(sample_total, a_ratio_of_totals_is_as_sharp_as_their_residuals_are_alike) {
  const unsigned seed = std::random_device{}();
  RecordProperty("seed", std::to_string(seed));
  std::mt19937 random(seed);
  const Population below(random);
  const std::vector<Draw> draws{below.draw(5, 6, random)};
  std::vector<Draw> doubled = draws;
  for (Measure& m : doubled[0].chunks) m.value *= 2;
  const Total total = estimate_total(draws, below.sizes, 3);
  const Ratio ratio = estimate_ratio(draws, estimate_total(doubled, below.sizes, 3), total, 0.95);
  EXPECT_NEAR(ratio.value, 2, 1e-9);
  EXPECT_NEAR(ratio.half_width, 0, 1e-9);
  EXPECT_GT(half_width(draws, total, 0.95) / total.value, 1e-3);
}

}  // namespace
