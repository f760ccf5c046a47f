// The ray-box paper's evaluation at a size for tests: what it claims holds for its own scene, and the published numbers
// are as printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "model/base/error.h"
#include "model/scene/load.h"
#include "sim/commands.h"
#include "sim/paper/raybox_tables.h"

namespace ctu::sim::paper {
namespace {

// Table 3 prints what follows from its own columns: 8 bytes a node and 4 a reference.
TEST(PublishedRaybox, tree_sizes_follow_from_nodes_and_references) {
  const auto kilobytes = [](const PublishedTree& t) { return (8 * t.nodes + 4 * t.references) / 1024; };
  const std::vector<double> balls = {574, 201, 106, 60, 45}, buddha = {85156, 67055, 40684, 19813, 11284};
  for (std::size_t i = 0; i < kLeafSizeCount; ++i) {
    EXPECT_NEAR(kilobytes(published_raybox()[0].trees[i]), balls[i], 1);
    EXPECT_NEAR(kilobytes(published_raybox()[2].trees[i]), buddha[i], 1);
  }
}

TEST(PublishedRaybox, up_to_92_percent_of_tests_are_removed) {
  double most = 0;
  for (const PublishedRaybox& scene : published_raybox())
    for (const PublishedCulling& row : scene.culling) most = std::max(most, 1 - row.culled_tests / row.tests);
  EXPECT_NEAR(most, 0.92, 0.005);
}

class BallsMeasured : public ::testing::Test {
 protected:
  static const RayboxResult& result() {
    static const RayboxResult measured = [] {
      const scene::Scene scene = scene::load("gen:balls");
      const RayboxSetting setting{
          .width = 60, .height = 60, .lights = {{{4, 3, 2}, 0}, {{1, -4, 4}, 0}, {{-3, 1, 5}, 0}}};
      return measure_raybox(scene, setting, 1, [](std::uint64_t) {});
    }();
    return measured;
  }
};

TEST_F(BallsMeasured, no_hit_is_lost) {
  EXPECT_EQ(result().changed.lost, 0u);
  EXPECT_EQ(result().spheres, 7381u);
  EXPECT_EQ(result().max_depth, 25);
  EXPECT_GT(result().shadow_rays, 2000u);
}

TEST_F(BallsMeasured, culling_removes_most_primitive_tests_of_large_leaves_and_keeps_their_number_flat) {
  double least = 1e9, most = 0;
  for (const KdResult& k : result().kd) {
    const double plain = static_cast<double>(k.plain.leaves.primitive_tests);
    const double culled = static_cast<double>(k.culled.leaves.primitive_tests);
    if (k.leaf_size >= 16) {
      EXPECT_GE(1 - culled / plain, 0.80) << "leaf size " << k.leaf_size;
    }
    // A hit behind the leaf ends the walk early only where it is not culled there.
    EXPECT_GE(k.culled.traversals(), k.plain.traversals());
    EXPECT_LE(static_cast<double>(k.culled.traversals()), 1.02 * static_cast<double>(k.plain.traversals()));
    least = std::min(least, culled);
    most = std::max(most, culled);
  }
  EXPECT_LE(most / least, 1.5);  // 3.14 / 2.30 in Table 2
}

TEST_F(BallsMeasured, the_report_has_every_table) {
  const std::string report = raybox_report({{result(), &published_raybox()[0], "a remark"}});
  for (const char* title :
       {"Table 2", "Table 3", "Figs. 4, 6 and 7", "Fig. 5", "Split clipping", "4-wide tree", "a remark"})
    EXPECT_NE(report.find(title), std::string::npos) << title;
}

TEST(RayboxCommand, a_scene_that_is_not_the_papers_is_refused) {
  PaperArgs args;
  args.scene.scenes = {"gen:tetra?depth=1"};
  EXPECT_THROW(paper_raybox_command(args), Error);
}

}  // namespace
}  // namespace ctu::sim::paper
