// Intervals of ratios against tables and against populations whose ratio is known.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/ladder/ratio_estimate.h"
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

TEST(ratio_estimate, of_parts_in_one_proportion_is_exact) {
  Drawn draw;
  for (int i = 1; i < 20; ++i) draw.parts.push_back({3.0 * i, 2.0 * i});
  const Ratio ratio = estimate_ratio({draw}, 0.95);
  EXPECT_DOUBLE_EQ(ratio.value, 1.5);
  EXPECT_NEAR(ratio.half_width, 0, 1e-12);
}

TEST(ratio_estimate, of_the_whole_population_leaves_no_doubt) {
  Drawn draw{{{1, 2}, {5, 2}, {2, 3}}, 1.0};
  EXPECT_DOUBLE_EQ(estimate_ratio({draw}, 0.95).half_width, 0);
}

/// Strata that change slowly, as rays of a picture do, with chance on top that is not normal.
TEST(ratio_estimate, intervals_hold_the_truth_at_their_stated_rate) {
  const unsigned seed = std::random_device{}();
  RecordProperty("seed", std::to_string(seed));
  std::mt19937 random(seed);
  constexpr int kStrata = 40, kPerStratum = 25, kRepetitions = 2000;
  std::vector<Part> population;
  std::gamma_distribution<double> spread(2.0, 0.5);
  Part sum;
  for (int i = 0; i < kStrata * kPerStratum; ++i) {
    const double size = 1 + spread(random);
    const double rate = 3 + std::sin(i * 0.01) + 0.6 * spread(random);
    population.push_back({size * rate, size});
    sum.above += size * rate;
    sum.below += size;
  }
  for (const double confidence : {0.8, 0.95}) {
    int covered = 0;
    for (int r = 0; r < kRepetitions; ++r) {
      Drawn draw;
      draw.share = 1.0 / kPerStratum;
      for (std::size_t s = 0; s < kStrata; ++s)
        draw.parts.push_back(population[s * kPerStratum + random() % kPerStratum]);
      const Ratio ratio = estimate_ratio({draw}, confidence);
      covered += std::abs(ratio.value - sum.above / sum.below) <= ratio.half_width;
    }
    // Four standard deviations of the count, and a point for what a ratio is off from normal with 40 parts.
    const double rate = static_cast<double>(covered) / kRepetitions;
    const double doubt = 4 * std::sqrt(confidence * (1 - confidence) / kRepetitions) + 0.01;
    EXPECT_GE(rate, confidence - doubt) << "seed " << seed;
  }
}

}  // namespace
