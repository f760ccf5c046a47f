// The published numbers are as printed: the paper prints means over its nine scenes, and a relative column, which ours
// must give again.
#include <gtest/gtest.h>

#include <functional>

#include "sim/paper/published_subspace.h"

namespace ctu::sim::paper {
namespace {

double mean(const std::function<double(const PublishedScene&)>& of) {
  double sum = 0;
  for (const PublishedScene& scene : published_scenes()) sum += of(scene);
  return sum / static_cast<double>(published_scenes().size());
}

// Each printed number is rounded to a tenth, the means too.
constexpr double kRounding = 0.1001;

TEST(PublishedSubspace, table_1_has_the_means_that_are_printed) {
  constexpr PublishedRatios kPrinted[] = {{75.4, 77.7, 77.2, 79.9}, {65.3, 68.8, 67.6, 75.2}};
  ASSERT_EQ(published_scenes().size(), 9u);
  for (std::size_t r = 0; r < kResolutions.size(); ++r) {
    EXPECT_NEAR(mean([&](auto& s) { return s.ratios[r].ideal; }), kPrinted[r].ideal, kRounding) << r;
    EXPECT_NEAR(mean([&](auto& s) { return s.ratios[r].lut; }), kPrinted[r].lut, kRounding) << r;
    EXPECT_NEAR(mean([&](auto& s) { return s.ratios[r].lut_double; }), kPrinted[r].lut_double, kRounding) << r;
    EXPECT_NEAR(mean([&](auto& s) { return s.ratios[r].compressed; }), kPrinted[r].compressed, kRounding) << r;
  }
}

TEST(PublishedSubspace, table_2_has_the_means_that_are_printed) {
  constexpr PublishedTimes kPrinted[] = {{124.1, 97.8, 98.8}, {125.0, 99.8, 106.2}};
  EXPECT_NEAR(mean([](auto& s) { return s.seconds; }), 94.42, 0.011);
  for (std::size_t r = 0; r < kResolutions.size(); ++r) {
    EXPECT_NEAR(mean([&](auto& s) { return s.times[r].ideal; }), kPrinted[r].ideal, kRounding) << r;
    EXPECT_NEAR(mean([&](auto& s) { return s.times[r].lut; }), kPrinted[r].lut, kRounding) << r;
    EXPECT_NEAR(mean([&](auto& s) { return s.times[r].lut_double; }), kPrinted[r].lut_double, kRounding) << r;
  }
}

TEST(PublishedSubspace, table_3_has_the_relative_times_that_are_printed) {
  constexpr double kPrinted[2][9] = {{9.4, 9.1, 11.1, 9.9, 9.4, 9.5, 10.2, 10.4, 9.1},
                                     {12.6, 10.7, 11.2, 11.6, 11.8, 15.0, 14.3, 17.2, 14.1}};
  for (std::size_t r = 0; r < kResolutions.size(); ++r)
    for (std::size_t i = 0; i < published_scenes().size(); ++i) {
      const PublishedSearch& search = published_scenes()[i].search[r];
      EXPECT_NEAR(100 * search.ours / search.naive, kPrinted[r][i], kRounding) << published_scenes()[i].name;
    }
}

TEST(PublishedSubspace, scenes_are_held_against_the_papers_by_name) {
  EXPECT_EQ(counterpart("san-miguel").kinship, Kinship::Same);
  EXPECT_STREQ(counterpart("san-miguel").scene->name, "San Miguel");
  EXPECT_STREQ(counterpart("gen:curly-hair?strands=7").scene->name, "Curly Hair");
  EXPECT_EQ(counterpart("bunny").kinship, Kinship::None);
  EXPECT_EQ(counterpart("bunny").scene, nullptr);
}

}  // namespace
}  // namespace ctu::sim::paper
