// Relations that hold between the columns of the paper's tables on any scene.
#include <gtest/gtest.h>

#include "model/accel/build.h"
#include "model/scene/load.h"
#include "sim/paper/subspace_measure.h"
#include "sim/paper/subspace_tables.h"

namespace ctu::sim::paper {
namespace {

class SubspaceMeasure : public ::testing::TestWithParam<int> {
 protected:
  static ResolutionResult measure(const RayTables& tables, int threads) {
    const scene::Scene scene = scene::load("gen:straight-hair?strands=300&seed=5");
    const accel::Bvh4 bvh = accel::build(scene.mesh, {});
    MeasureOptions options;
    options.survey.rays.kind = traces::RayOptions::Rays::Diffuse;
    options.survey.rays.width = 48;
    options.survey.rays.height = 48;
    options.survey.threads = threads;
    options.survey.timed_repeats = threads;
    options.repeats = 1;
    return measure_subspace(scene, bvh, tables, options, [](std::uint64_t) {});
  }
  static double percent(const ResolutionResult& result, Column column) {
    return result.columns[static_cast<std::size_t>(column)].percent;
  }
};

/// A key that rounding leaves uncertain passes its child, so a finer grid may pass one that a coarser one culls.
constexpr double kUncertainPercent = 0.02;

TEST_P(SubspaceMeasure, finer_rays_and_tighter_masks_never_cull_less) {
  const ResolutionResult result = measure(RayTables(GetParam()), 1);
  const auto at_most = [&](Column a, Column b) {
    EXPECT_LE(percent(result, a), percent(result, b) + kUncertainPercent)
        << static_cast<int>(a) << " " << static_cast<int>(b);
  };
  at_most(Column::Ideal, Column::LutDouble);
  at_most(Column::Ideal, Column::Comparators);
  at_most(Column::LutDouble, Column::Lut);
  at_most(Column::Lut, Column::CompressedOurs);
  at_most(Column::Lut, Column::CompressedSummed);
  at_most(Column::Lut, Column::CompressedPaper);
  at_most(Column::CompressedPaper, Column::NoCulling);
  EXPECT_EQ(percent(result, Column::NoCulling), 100);
  EXPECT_EQ(percent(result, Column::Unasked), 100);
  EXPECT_EQ(percent(result, Column::BitTable), percent(result, Column::CompressedOurs));
  EXPECT_LT(percent(result, Column::Lut), 95) << "thin tilted geometry must be culled";
  ASSERT_EQ(result.levels.size(), 6u);
  for (std::size_t l = 1; l < result.levels.size(); ++l)
    EXPECT_LE(result.levels[l].percent, result.levels[l - 1].percent + kUncertainPercent) << l;
  EXPECT_EQ(result.levels.back().percent, percent(result, Column::Lut));
}

TEST_P(SubspaceMeasure, no_hit_is_lost_and_both_searches_find_the_same_entries) {
  const ResolutionResult result = measure(RayTables(GetParam()), 1);
  EXPECT_EQ(result.lost_hits, 0u);
  EXPECT_EQ(result.search.differences, 0u);
  EXPECT_GT(result.search.masks, 1000u);
}

TEST_P(SubspaceMeasure, counts_do_not_depend_on_threads_or_timing) {
  const RayTables tables(GetParam());
  const ResolutionResult one = measure(tables, 1), three = measure(tables, 3);
  EXPECT_EQ(one.rays, three.rays);
  EXPECT_EQ(one.intersections_per_ray, three.intersections_per_ray);
  for (std::size_t c = 0; c < kColumns; ++c) EXPECT_EQ(one.columns[c].percent, three.columns[c].percent) << c;
  for (std::size_t l = 0; l < one.levels.size(); ++l) EXPECT_EQ(one.levels[l].percent, three.levels[l].percent) << l;
}

INSTANTIATE_TEST_SUITE_P(Resolutions, SubspaceMeasure, ::testing::Values(4, 6));

TEST(Median, is_the_middle_one) {
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({9, 1, 5}), 5);
  EXPECT_EQ(median({4, 3, 2, 1}), 2);
}

TEST(SubspaceTables, steps_that_differ_by_more_than_three_points_are_in_bold) {
  SceneResult scene;
  scene.name = "gen:straight-hair";
  for (std::size_t r = 0; r < kResolutions.size(); ++r) {
    const PublishedRatios& paper = counterpart(scene.name).scene->ratios[r];
    auto& columns = scene.at[r].columns;
    columns[static_cast<std::size_t>(Column::Ideal)].percent = paper.ideal + 3.1;
    columns[static_cast<std::size_t>(Column::Lut)].percent = paper.lut + 3.1;
    columns[static_cast<std::size_t>(Column::LutDouble)].percent = paper.lut_double + 3.1;
    columns[static_cast<std::size_t>(Column::CompressedPaper)].percent = paper.compressed + 0.2;
    columns[static_cast<std::size_t>(Column::CompressedSummed)].percent = paper.compressed + 6.2;
  }
  const std::string table = step_table({scene});
  EXPECT_NE(table.find("| 4 | **-40.4 / -43.5** | +4.9 / +4.9 | -1.1 / -1.1 | -2.2 / +0.7 | **+3.8 / +0.7** |"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("| 0 of 2 | 2 of 2 | 2 of 2 | 2 of 2 | 0 of 2 |"), std::string::npos) << table;
}

}  // namespace
}  // namespace ctu::sim::paper
