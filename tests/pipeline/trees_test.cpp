// Rays that begin at the roots of several trees: what each visits is what the reference says, in every execution,
// alone and in packets; and a unit with one tree knows nothing of others.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "model/accel/build.h"
#include "model/accel/forest.h"
#include "model/base/error.h"
#include "model/scene/load.h"
#include "model/unit/run.h"
#include "tests/oracle/seed.h"
#include "tests/pipeline/world.h"

namespace ctu::test {
namespace {

using cull::Design;
using pipeline::UnitConfig;
using pipeline::UnitResult;

/// Three trees over the same strands, so that a ray's answer is the same in each.
accel::Bvh4 three_trees() {
  const scene::Mesh mesh = scene::load("gen:hair-ball?strands=120").mesh;
  accel::Bvh4 trees = accel::build(mesh, {});
  accel::append_tree(trees, accel::build(mesh, {.max_leaf_triangles = 1}));
  accel::append_tree(trees, accel::build(mesh, {.max_leaf_triangles = 9, .triangle_cost = 0.2}));
  return trees;
}

struct Case {
  Design design;
  std::uint32_t box_bits = accel::kFullBoxBits;
  bool primitive_boxes = false;
  reference::PacketPlan packets = {};
};
constexpr Case kCases[] = {
    {Design::None}, {Design::Projection, 12}, {Design::Comparators, 32, true}, {Design::MaskLut, 32, false, {8, 4}}};

World world_of(const Case& c) {
  World world(three_trees(), c.design, 240, {}, c.box_bits, c.primitive_boxes);
  world.walk_trees({0, 2, 1, 1, 1, 1, 2, 2, 2});
  if (c.packets.any()) world.travel_in(c.packets);
  return world;
}

TEST(Trees, each_ray_visits_what_the_reference_recorded_in_its_tree) {
  SCOPED_TRACE(oracle::seed_note());
  for (const Case& c : kCases)
    for (const bool exec : {false, true}) {
      SCOPED_TRACE(std::string(cull::to_string(c.design)) + (exec ? ", exec" : ", replay"));
      World world = world_of(c);
      const auto engine = world.engine(world.config(), {.exec = exec, .keep_events = true});
      const UnitResult result = pipeline::run_to_end(*engine);
      EXPECT_EQ(result.wrong_hits, 0u);
      EXPECT_EQ(result.other_visits, 0u);
      auto events = engine->log().events();
      std::erase_if(events, [](const auto& e) { return e.is_return || (!e.step.is_leaf() && (e.step.detail >> 15)); });
      std::sort(events.begin(), events.end(),
                [](const auto& a, const auto& b) { return std::tuple(a.ray, a.visit) < std::tuple(b.ray, b.visit); });
      std::size_t next = 0;
      for (const auto& block : world.blocks())
        for (const reference::Step& step : block->steps.steps) {
          ASSERT_LT(next, events.size());
          ASSERT_EQ(events[next++].step, step);
        }
      EXPECT_EQ(next, events.size());
      EXPECT_EQ(result.counts.node_visits, world.counts().node_visits);
    }
}

TEST(Trees, rays_of_every_tree_begin_at_its_root_and_find_what_they_find_in_the_first) {
  World world = world_of(kCases[0]);
  const World alone(three_trees(), Design::None, 240);
  std::vector<int> rays(3);
  for (std::size_t b = 0; b < world.blocks().size(); ++b) {
    const reference::RayBlock& block = *world.blocks()[b];
    for (std::size_t i = 0; i < block.rays.size(); ++i) {
      if (block.steps.first_step[i] == block.steps.first_step[i + 1]) continue;
      ++rays[block.trees[i].tree];
      EXPECT_EQ(block.steps.steps[block.steps.first_step[i]].ref, world.tree().root(block.trees[i].tree));
      const intersect::Hit& first = alone.blocks()[b]->expected[i];
      if (block.rays[i].kind == intersect::RayKind::ClosestHit)
        EXPECT_TRUE(intersect::same_bits(block.expected[i], first)) << block.first_ray + i;
      else
        EXPECT_EQ(block.expected[i].primitive == intersect::kNoPrimitive, first.primitive == intersect::kNoPrimitive);
    }
  }
  EXPECT_GT(*std::min_element(rays.begin(), rays.end()), 10);
}

TEST(Trees, every_execution_takes_the_same_cycles) {
  for (const Case& c : kCases) {
    World world = world_of(c);
    const auto run_in = [&](unit::Mode mode) {
      VectorFeed feed(world.blocks(), c.packets);
      return unit::run(world.config(), {world.image(), world.tester(), feed}, {.mode = mode});
    };
    const UnitResult plain = run_in(unit::Mode::Plain);
    EXPECT_EQ(plain.wrong_hits, 0u);
    for (const unit::Mode mode : {unit::Mode::Batch, unit::Mode::Cycle, unit::Mode::Pins}) {
      const UnitResult other = run_in(mode);
      EXPECT_EQ(plain.cycles, other.cycles) << cull::to_string(c.design);
      EXPECT_EQ(plain.event_log_hash, other.event_log_hash) << cull::to_string(c.design);
    }
  }
}

TEST(Trees, counters_say_what_they_save_and_a_unit_with_one_tree_has_none) {
  World world = world_of(kCases[0]);
  std::uint64_t local = 0;
  for (const auto& block : world.blocks())
    for (const reference::RayTree& tree : block->trees) local += tree.tree != 0;
  const UnitResult result = world.run(world.config());
  EXPECT_EQ(result.counter("trees.local_rays"), local);
  EXPECT_EQ(result.counter("trees.own_tests"), 240u);
  EXPECT_EQ(result.counter("trees.global_tests"), 480u);
  World one("gen:tilted-quads?quads=100", Design::None, 50);
  EXPECT_FALSE(one.run(one.config()).counter("trees.local_rays"));
}

TEST(Trees, a_ray_of_a_tree_that_the_image_does_not_have_is_refused) {
  World world("gen:tilted-quads?quads=100", Design::None, 50);
  world.walk_trees({0});
  auto block = std::make_shared<reference::RayBlock>(*world.blocks()[0]);
  block->trees[7].tree = 1;
  const std::vector<std::shared_ptr<const reference::RayBlock>> blocks{block};
  VectorFeed feed(blocks);
  EXPECT_THROW(pipeline::make_engine(world.config(), {world.image(), world.tester(), feed}, {}), Error);
}

}  // namespace
}  // namespace ctu::test
