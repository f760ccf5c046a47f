// `ctusim paper raydist` on generated scenes: the tables, and the laws behind their numbers.
#include <gtest/gtest.h>

#include <cmath>

#include "model/scene/load.h"
#include "sim/paper/published_raydist.h"
#include "sim/paper/raydist_tables.h"
#include "tests/sim/program.h"

namespace ctu::sim::paper {
namespace {

RayDistributionOptions small() {
  RayDistributionOptions options;
  options.rays.width = 96;
  options.rays.height = 64;
  options.build.bins = 40;
  options.build.max_leaf_triangles = 2;
  options.affine_rays = 1500;
  return options;
}

TEST(RayDistribution, predicts_costs_within_the_goal_and_loses_no_hit_under_every_light) {
  const scene::Scene scene = scene::load("gen:tilted-quads?quads=1500&size=0.2");
  const accel::Bvh4 global =
      influence::build_for(scene.mesh, {}, compared_heuristics()[kBaseline].heuristic, small().build);
  RayDistributionScene result{"quads", scene.mesh.triangles.size(), {}};
  const std::vector<TestLight> lights = test_lights(scene);
  ASSERT_EQ(lights.size(), 8u);
  for (const TestLight& light : lights) {
    result.lights.push_back(measure_light(scene, global, light, small()));
    const LightResult& r = result.lights.back();
    ASSERT_EQ(r.heuristics.size(), compared_heuristics().size()) << light.name();
    EXPECT_EQ(r.found_kind, light.kind) << light.name();
    EXPECT_EQ(r.selection.lost, 0u) << light.name();
    EXPECT_EQ(r.selection.changed, 0u) << light.name();
    EXPECT_GT(r.selection.final, 9 * r.selection.rays / 10) << light.name();
    EXPECT_GE(r.selection.memory_ratio, 1);
    for (const HeuristicResult& h : r.heuristics) {
      EXPECT_GE(h.crossing, h.closest) << "a ray that ends does no more";
      EXPECT_GT(h.build_seconds, 0);
    }
  }
  const PredictionError error = prediction_error({result});
  EXPECT_EQ(error.cases, 8 * compared_heuristics().size());
  EXPECT_LT(error.projected, kProjectedErrorGoal);
  EXPECT_GT(error.surface, error.projected);
}

TEST(RayDistribution, lights_stand_on_four_sides_far_away_and_near) {
  const scene::Scene scene = scene::load("gen:tetra?depth=2");
  const auto lights = test_lights(scene);
  const auto from_middle = [&](const TestLight& light) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
      sum += std::pow(light.place[axis] - 0.5 * (double(scene.lower[axis]) + scene.upper[axis]), 2);
    return std::sqrt(sum);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(lights[i].kind, influence::AreaKind::Plane);
    EXPECT_GT(from_middle(lights[i]), 500 * from_middle(lights[i + 4]));
  }
}

TEST(RayDistribution, the_octree_finds_what_asking_each_area_finds) {
  for (const LookupResult& lookup : measure_lookups(7)) {
    EXPECT_TRUE(lookup.agree) << lookup.areas;
    EXPECT_GE(lookup.named, lookup.containing);
    EXPECT_LE(lookup.named, lookup.areas);
  }
}

TEST(PaperRaydistCommand, prints_every_table_beside_the_published_numbers) {
  const test::ScratchFolder folder;
  const test::Outcome outcome =
      test::run_program(folder.path(), "paper raydist gen:tetra?depth=4 --size 64x48 --quick");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* text :
       {"Predicted against measured cost", "### Heuristics", "| SPFH strict + SAH |", "Shadow rays by scene and light",
        "point, oblique", "areas found from the rays", "Looking up", "*paper*"})
    EXPECT_NE(outcome.out.find(text), std::string::npos) << text;
  EXPECT_EQ(test::run_program(folder.path(), "paper raydist nowhere.obj").exit_code, 2);
  EXPECT_EQ(test::run_program(folder.path(), "paper raydist gen:tetra --size 5").exit_code, 2);
}

TEST(TraceAreasCommand, finds_the_light_of_a_recorded_trace_and_changes_no_answer) {
  const test::ScratchFolder folder;
  const test::Outcome recorded =
      test::run_program(folder.path(), "record gen:tetra?depth=5 -o t.ctut --rays shadow --size 64x48 --culling off");
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const test::Outcome outcome = test::run_program(folder.path(), "trace areas t.ctut");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("  point near "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("global tree: 0; lost hits: 0"), std::string::npos) << outcome.out;
  EXPECT_EQ(test::run_program(folder.path(), "trace areas nowhere.ctut").exit_code, 2);
}

}  // namespace
}  // namespace ctu::sim::paper
