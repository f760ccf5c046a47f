// Whether culling pays: samples are parts of the whole, stripping masks keeps every hit, masks are kept exactly where
// they save something, and the forecast is what the recorded trace takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/cull/strip_masks.h"
#include "model/pipeline/backpressure.h"
#include "model/scene/load.h"
#include "sim/culling_decision.h"
#include "sim/unit_runner.h"
#include "tests/oracle/seed.h"

namespace ctu::sim {
namespace {

using cull::Design;

traces::RecordOptions small_options(std::uint32_t width = 48, std::uint32_t height = 40) {
  traces::RecordOptions options;
  options.rays.kind = traces::RayOptions::Rays::Diffuse;
  options.rays.width = width;
  options.rays.height = height;
  options.rays.bounces = 2;
  options.threads = 2;
  return options;
}

/// A scene with its tree, masks, and all of its rays.
struct World {
  explicit World(const std::string& name, traces::RecordOptions options_ = small_options())
      : scene(scene::load(name)),
        options(std::move(options_)),
        bvh(accel::build(scene.mesh, options.build)),
        masks(traces::make_masks(bvh, options.masks, options.threads)),
        generator(scene, options.rays),
        rays(sample_rays(generator, walk, {}, 1)) {}

  traces::RecordedTree tree() const { return {.bvh = bvh, .masks = masks, .culling = {}}; }
  reference::Counts counts(const cull::ObjectMasks& object_masks) const {
    const reference::Traversal culled(bvh, &object_masks, tester);
    reference::StepList steps;
    for (const intersect::Ray& ray : rays.rays) culled.trace(ray, &steps);
    return reference::count_steps(steps, 0, steps.rays());
  }

  scene::Scene scene;
  traces::RecordOptions options;
  accel::Bvh4 bvh;
  traces::MaskSet masks;
  traces::RayGenerator generator;
  cull::MaskTester none{Design::None, options.masks}, tester{Design::Projection, options.masks, masks.lut};
  reference::Traversal walk{bvh, nullptr, none};
  RaySample rays;
};

bool same_ray(const intersect::Ray& a, const intersect::Ray& b) {
  return a.origin == b.origin && a.direction == b.direction && a.tmax == b.tmax;
}

TEST(RaySample, is_a_part_of_all_rays_in_their_order_and_does_not_depend_on_threads) {
  const World world("gen:hair-ball?strands=300");
  EXPECT_TRUE(world.rays.whole);
  const SampleOptions options{.rays = 400, .runs = 7};
  const RaySample sample = sample_rays(world.generator, world.walk, options, 1);
  EXPECT_FALSE(sample.whole);
  EXPECT_GT(sample.rays.size(), 300u);
  EXPECT_LT(sample.rays.size(), 600u);
  std::size_t next = 0;
  for (std::size_t i = 0; i < sample.rays.size(); ++i, ++next) {
    while (next < world.rays.rays.size() && !same_ray(world.rays.rays[next], sample.rays[i])) ++next;
    ASSERT_LT(next, world.rays.rays.size()) << "ray " << i << " is not one of the scene's, in order";
    EXPECT_TRUE(same_bits(world.rays.hits[next], sample.hits[i]));
  }
  const RaySample threaded = sample_rays(world.generator, world.walk, options, 4);
  ASSERT_EQ(threaded.rays.size(), sample.rays.size());
  EXPECT_TRUE(std::equal(sample.rays.begin(), sample.rays.end(), threaded.rays.begin(), same_ray));
  const RaySample large = sample_rays(world.generator, world.walk, {.rays = 1u << 30}, 2);
  EXPECT_TRUE(large.whole);
  EXPECT_EQ(large.rays.size(), world.rays.rays.size());
}

TEST(RaySample, of_another_phase_has_other_rays) {
  const World world("gen:hair-ball?strands=300");
  const RaySample one = sample_rays(world.generator, world.walk, {.rays = 200}, 1);
  const RaySample other = sample_rays(world.generator, world.walk, {.rays = 200, .phase = 0.5}, 1);
  std::size_t shared = 0;
  for (const intersect::Ray& ray : one.rays)
    shared += std::any_of(other.rays.begin(), other.rays.end(), [&](const auto& r) { return same_ray(r, ray); });
  EXPECT_LT(shared, one.rays.size() / 2);
}

class StrippedMasks : public ::testing::TestWithParam<int> {};

TEST_P(StrippedMasks, keep_every_hit_and_cull_no_more_than_all_masks) {
  traces::RecordOptions options = small_options(32, 32);
  options.masks.entries = GetParam();
  const World world("gen:straight-hair?strands=200", options);
  SCOPED_TRACE(oracle::seed_note());
  std::vector<std::uint8_t> kept(world.bvh.nodes.size());
  for (std::size_t node = 0; node < kept.size(); ++node)
    kept[node] = static_cast<std::uint8_t>(pipeline::mix64(oracle::test_seed() + node) & 15u);
  const cull::ObjectMasks stripped = cull::strip_masks(world.bvh, world.masks.masks, world.masks.lut.get(), kept);
  const reference::Traversal culled(world.bvh, &stripped, world.tester);
  for (std::size_t i = 0; i < world.rays.rays.size(); ++i)
    EXPECT_TRUE(same_bits(culled.trace(world.rays.rays[i]), world.rays.hits[i])) << "ray " << i;

  const std::uint64_t all = world.counts(world.masks.masks).culled, some = world.counts(stripped).culled;
  EXPECT_LT(some, all);
  EXPECT_GT(some, 0u);
  EXPECT_LT(cull::nodes_with_masks(world.bvh, stripped), cull::nodes_with_masks(world.bvh, world.masks.masks));
}
INSTANTIATE_TEST_SUITE_P(Entries, StrippedMasks, ::testing::Values(0, 32));

TEST(StrippedMasks, of_another_tree_are_refused) {
  const World world("gen:tetra");
  EXPECT_THROW(cull::strip_masks(world.bvh, world.masks.masks, nullptr, {15}), Error);
}

TEST(MaskWorth, when_look_ups_are_free_every_mask_that_saves_an_intersection_is_kept) {
  const World world("gen:hair-ball?strands=300");
  const auto kept =
      lanes_that_pay(world.bvh, world.masks.masks, world.tester, world.rays, {.node = 1, .leaf = 0, .triangle = 1}, 1);
  const auto stripped = cull::strip_masks(world.bvh, world.masks.masks, nullptr, kept);
  EXPECT_EQ(world.counts(stripped).intersections(), world.counts(world.masks.masks).intersections());
}

TEST(MaskWorth, when_a_look_up_costs_more_than_any_walk_no_mask_is_kept) {
  const World world("gen:hair-ball?strands=300");
  const auto kept = lanes_that_pay(world.bvh, world.masks.masks, world.tester, world.rays,
                                   {.node = 1, .look_up = 1e6, .leaf = 0, .triangle = 1}, 1);
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 0), static_cast<std::ptrdiff_t>(kept.size()));
}

TEST(MaskWorth, when_bytes_cost_more_than_any_walk_no_node_carries_masks) {
  const World world("gen:hair-ball?strands=300");
  const auto kept = lanes_that_pay(world.bvh, world.masks.masks, world.tester, world.rays,
                                   {.node = 1, .mask_bytes = 1e6, .leaf = 0, .triangle = 1}, 1);
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 0), static_cast<std::ptrdiff_t>(kept.size()));
}

/// Work of the walk as the model prices it.
double priced(const World& world, const cull::ObjectMasks& masks, const VisitCosts& costs) {
  const reference::Counts counts = world.counts(masks);
  const reference::Traversal culled(world.bvh, &masks, world.tester);
  double asked = 0;
  reference::StepList steps;
  for (const intersect::Ray& ray : world.rays.rays) culled.trace(ray, &steps);
  for (const reference::Step& step : steps.steps)
    if (!step.is_leaf())
      asked += std::popcount(step.box_hits() & ~cull::full_lanes(masks.mask(step.ref, 0), masks.resolution));
  return costs.node * double(counts.node_visits) + costs.triangle * double(counts.triangle_tests) +
         costs.leaf * double(counts.leaf_visits) + costs.look_up * asked;
}

TEST(MaskWorth, masks_that_pay_cost_less_than_all_masks_and_than_none_by_the_prices_given) {
  for (const char* name : {"gen:hair-ball?strands=300", "gen:tetra", "gen:straight-hair?strands=300", "gen:foliage"}) {
    const World world(name);
    for (const double look_up : {0.01, 0.1, 0.3, 1.0}) {
      const VisitCosts costs{.node = 1, .look_up = look_up, .leaf = 0.5, .triangle = 0.5};
      const auto kept = lanes_that_pay(world.bvh, world.masks.masks, world.tester, world.rays, costs, 2);
      const double some = priced(world, cull::strip_masks(world.bvh, world.masks.masks, nullptr, kept), costs);
      const double all = priced(world, world.masks.masks, costs);
      const double none = priced(
          world, cull::strip_masks(world.bvh, world.masks.masks, nullptr, std::vector<std::uint8_t>(kept.size())),
          costs);
      EXPECT_LE(some, 1.002 * std::min(all, none)) << name << ", look-up " << look_up << ": " << all << ", " << none;
    }
  }
}

TEST(CullingDecision, leaves_out_masks_where_boxes_are_full_and_keeps_them_for_hair) {
  const World tetra("gen:tetra"), hair("gen:straight-hair?strands=500");
  EXPECT_EQ(decide_culling(tetra.scene, tetra.tree(), tetra.options, {}).tree.culling.choice, "off");
  EXPECT_NE(decide_culling(hair.scene, hair.tree(), hair.options, {}).tree.culling.choice, "off");
}

TEST(CullingDecision, is_the_same_for_any_number_of_threads) {
  World world("gen:hair-ball?strands=300");
  const DecisionOptions options{.config = {}, .pilot_rays = 500};
  const auto said = decide_culling(world.scene, world.tree(), world.options, options).tree.culling;
  world.options.threads = 1;
  EXPECT_EQ(said, decide_culling(world.scene, world.tree(), world.options, options).tree.culling);
}

TEST(CullingDecision, a_unit_that_does_not_cull_needs_no_masks) {
  const World world("gen:tetra");
  DecisionOptions options;
  options.config.mask_test.design = Design::None;
  const CullingDecision decision = decide_culling(world.scene, world.tree(), world.options, options);
  EXPECT_EQ(decision.tree.culling.choice, "off");
  EXPECT_FALSE(decision.with_masks);
  EXPECT_TRUE(decision.tree.masks.masks.bits.empty());
}

/// Cycles per ray of the recorded trace, run as `ctusim run` does.
double run_recorded(const World& world, traces::RecordOptions options, const CullingDecision& decision) {
  const auto path = (std::filesystem::temp_directory_path() / "ctu-culling-decision-test.ctut").string();
  options.with_masks = decision.with_masks;
  if (!options.with_masks) options.designs = {Design::None};
  traces::record(world.scene, options, decision.tree, path);
  const LoadedTrace trace(path);
  EXPECT_EQ(trace.reader().manifest().culling, decision.tree.culling);
  RunPlan plan;
  plan.options.mode = unit::Mode::Plain;
  if (!options.with_masks) plan.config.mask_test.design = Design::None;
  plan.range = trace.range(0, 0);
  const RunRecord record = run_plan(trace, plan);
  EXPECT_EQ(record.result.wrong_hits, 0u);
  std::filesystem::remove(path);
  return record.cycles_per_ray();
}

TEST(CullingDecision, its_forecast_from_all_rays_is_what_the_recorded_trace_takes_cycle_for_cycle) {
  for (const char* name : {"gen:tetra", "gen:straight-hair?strands=500"}) {
    const World world(name);
    const CullingDecision decision = decide_culling(world.scene, world.tree(), world.options, {});
    const auto& rows = decision.tree.culling.forecasts;
    const auto chosen = std::find_if(rows.begin(), rows.end(),
                                     [&](const auto& row) { return row.name == decision.tree.culling.choice; });
    ASSERT_NE(chosen, rows.end());
    EXPECT_EQ(decision.tree.culling.pilot_rays, world.rays.rays.size());
    EXPECT_EQ(run_recorded(world, world.options, decision), chosen->cycles_per_ray) << name;
  }
}

}  // namespace
}  // namespace ctu::sim
