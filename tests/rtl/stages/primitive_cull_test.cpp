// rtl/primitive_cull.sv against the model's primitive_cull within a unit at work: every handshake, every set of
// primitives and account in every cycle.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "VMutantRayBoxInward.h"
#include "VMutantRayBoxTwoAxes.h"
#include "VPrimitiveCull1.h"
#include "VPrimitiveCull2.h"
#include "VPrimitiveCull3.h"
#include "VPrimitiveCull4.h"
#include "model/accel/build.h"
#include "model/numeric/round.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/rtl/stages/stage_run.h"
#include "tests/support/aimed_rays.h"

namespace ctu::rtl {
namespace {

using numeric::bits;

constexpr int kSlotBits = 5;

struct Compared {
  std::string difference;
  std::uint64_t leaves = 0, passed = 0, missed = 0;
};

/// What the twin reads of its contexts: rays, stays and best hits from before the cycle, and the boxes of leaves.
template <int kUnits, class Model>
void answer(Model& twin, pipeline::TappedUnit& unit, const accel::Image& image, const std::vector<float>& best_t) {
  if (twin.slot_o >= unit.state().contexts.count()) return;
  const pipeline::ExecSource::Registers& r = unit.state().source.registers(twin.slot_o);
  BitWriter origin(&twin.ray_origin_i[0]), direction(&twin.ray_direction_i[0]), boxes(&twin.box_i[0]);
  for (int axis = 0; axis < 3; ++axis) {
    origin.put(r.ray.ray.origin[axis]);
    direction.put(r.ray.ray.direction[axis]);
  }
  twin.stay_begin_i = bits(r.t0);
  twin.stay_end_i = bits(r.t1);
  twin.best_t_i = bits(best_t[twin.slot_o]);
  for (int u = 0; u < kUnits; ++u) {
    const int index = static_cast<int>(twin.index_o >> (4 * u) & 15u);
    const bool there = accel::is_leaf(r.step.ref) && index < accel::leaf_count(r.step.ref);
    const accel::PrimitiveBox box =
        there ? accel::read_primitive_box(image, accel::leaf_first(r.step.ref) + static_cast<unsigned>(index))
              : accel::PrimitiveBox{};
    for (const Vec3* corner : {&box.lower, &box.upper})
      for (int axis = 0; axis < 3; ++axis) boxes.put((*corner)[axis]);
  }
}

/// The twin beside the model's stage for one run.
template <class Model, int kUnits>
Compared compare(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed) {
  VerilatedContext context;
  Model twin(from_noise(context));
  reset(twin);
  StageRun run(world, config, stall_seed);
  auto& stage = *run.unit().stages().primitive_cull;
  std::vector<float> best_t(1u << kSlotBits);
  Difference difference;
  Compared compared;
  compared.difference = run.first_difference([&] {
    twin.leaf_valid_i = stage.leaf.valid;
    twin.leaf_data_i = static_cast<std::uint64_t>(stage.leaf.token.slot) << 32 | stage.leaf.token.ref;
    twin.passed_ready_i = stage.passed.ready;
    twin.missed_ready_i = stage.missed.ready;
    twin.eval();
    answer<kUnits>(twin, run.unit(), world.image(), best_t);
    twin.eval();
    difference.same("leaf pop", twin.leaf_pop_o, stage.leaf.popped)
        .same("passed push", twin.passed_push_o, stage.passed.pushed)
        .same("missed push", twin.missed_push_o, stage.missed.pushed)
        .same("activity", twin.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.passed.pushed) {
      const pipeline::LeafToken& token = stage.passed.token;
      difference.same("passed", twin.passed_data_o,
                      static_cast<std::uint64_t>(token.slot) << 48 | std::uint64_t{token.met} << 32 | token.ref);
    }
    if (stage.missed.pushed) difference.same("missed", twin.missed_data_o, stage.missed.token.slot);
    compared.leaves += stage.leaf.popped;
    compared.passed += stage.passed.pushed;
    compared.missed += stage.missed.pushed;
    clock(twin);
    for (int slot = 0; slot < run.unit().state().contexts.count(); ++slot)
      best_t[static_cast<std::size_t>(slot)] =
          run.unit().state().source.registers(static_cast<pipeline::Slot>(slot)).best.t;
    return difference.take();
  });
  return compared;
}

/// Rays at triangles from every direction, some along axes, that end before the scene, right at their hit, or nowhere.
std::vector<intersect::Ray> rays_at(const accel::Bvh4& tree, int count) {
  std::mt19937_64 random(oracle::test_seed());
  const auto uniform = [&] { return static_cast<float>(random() >> 40) * 0x1p-24f; };
  std::vector<intersect::Ray> rays(static_cast<std::size_t>(count));
  const cull::MaskTester no_culling(cull::Design::None, {});
  const reference::Traversal traversal(tree, nullptr, no_culling);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    intersect::Ray& ray = rays[i];
    const accel::LeafTriangle& target = tree.triangles[random() % tree.triangles.size()];
    for (int axis = 0; axis < 3; ++axis) {
      const float size = tree.upper[axis] - tree.lower[axis];
      ray.origin[axis] = tree.lower[axis] + size * (3 * uniform() - 1);
      ray.direction[axis] = (target.v0[axis] + target.v1[axis] + target.v2[axis]) / 3 - ray.origin[axis];
    }
    if (i % 3 == 1) ray.direction[static_cast<int>(i / 3 % 3)] = i % 2 == 0 ? 0.0f : -0.0f;
    if (i % 5 == 2) ray.direction[static_cast<int>(i % 3)] *= 1e-30f;
    ray.tmax = std::numeric_limits<float>::infinity();
    if (i % 8 == 0) ray.tmax = uniform();
    if (i % 2 == 1) ray.tmax = traversal.trace(ray).t;
  }
  return rays;
}

test::World large_leaves(const scene::Mesh& mesh) {
  const accel::Bvh4 tree = accel::build(mesh, {.max_leaf_triangles = accel::kMaxLeafTriangles, .triangle_cost = 0.05f});
  return {tree, cull::Design::None, rays_at(tree, 400), {}, accel::kFullBoxBits, true};
}

const test::World& scene() {
  static const test::World world = large_leaves(scene::load("gen:hair-ball?strands=120").mesh);
  return world;
}

/// Triangles flat in the faces of their leaves' boxes, so that a ray's stay begins and ends right on their boxes.
const test::World& flat_triangles() {
  static const test::World world = large_leaves(test::closed_cube(4).mesh);
  return world;
}

pipeline::UnitConfig config_of(int units, int latency) {
  pipeline::UnitConfig config = scene().config();
  config.ray_setup.interval = 1;
  config.primitive_cull = {.units = units, .latency = latency};
  return config;
}

template <class Model, int kUnits>
void expect_equal(int latency) {
  SCOPED_TRACE(oracle::seed_note());
  for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed(), oracle::test_seed() + 1}) {
    const Compared compared = compare<Model, kUnits>(scene(), config_of(kUnits, latency), stall_seed);
    EXPECT_EQ(compared.difference, "") << "units " << kUnits << ", stall seed " << stall_seed;
    EXPECT_EQ(compared.leaves, scene().counts().leaf_visits);
    EXPECT_EQ(compared.passed + compared.missed, compared.leaves);
    EXPECT_GT(compared.passed, 200u);
    EXPECT_GT(compared.missed, 20u);
    EXPECT_EQ((compare<Model, kUnits>(flat_triangles(), config_of(kUnits, latency), stall_seed).difference), "");
  }
}

TEST(PrimitiveCull, equals_the_model_with_a_box_a_cycle_at_latency_1) { expect_equal<VPrimitiveCull1, 1>(1); }
TEST(PrimitiveCull, equals_the_model_with_two_boxes_a_cycle_at_latency_4) { expect_equal<VPrimitiveCull2, 2>(4); }
TEST(PrimitiveCull, equals_the_model_with_three_boxes_a_cycle_at_latency_10) { expect_equal<VPrimitiveCull3, 3>(10); }
TEST(PrimitiveCull, equals_the_model_with_four_boxes_a_cycle_at_latency_23) { expect_equal<VPrimitiveCull4, 4>(23); }

TEST(PrimitiveCullMutants, a_box_rounded_inward_is_caught) {
  SCOPED_TRACE(oracle::seed_note());
  EXPECT_NE((compare<VMutantRayBoxInward, 1>(flat_triangles(), config_of(1, 1), 0).difference), "");
}
TEST(PrimitiveCullMutants, boxes_compared_on_two_axes_are_caught) {
  SCOPED_TRACE(oracle::seed_note());
  EXPECT_NE((compare<VMutantRayBoxTwoAxes, 1>(scene(), config_of(1, 1), 0).difference), "");
}

}  // namespace
}  // namespace ctu::rtl
