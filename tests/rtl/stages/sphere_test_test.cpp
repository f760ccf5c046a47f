// rtl/sphere_test.sv against the model's sphere_test within a unit at work: every handshake, outcome and account in
// every cycle.
#include <gtest/gtest.h>

#include <vector>

#include "VSphereTest1.h"
#include "VSphereTest21.h"
#include "VSphereTest89.h"
#include "model/accel/build.h"
#include "model/numeric/round.h"
#include "model/scene/load.h"
#include "sim/cosim/token_bits.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using numeric::bits;

constexpr int kSlotBits = 5;

struct Compared {
  std::string difference;
  std::uint64_t spheres = 0, outcomes = 0, hits = 0;
};

/// What the twin reads of its contexts: rays and best hits from before the cycle, and the spheres of leaves.
template <class Model>
void answer(Model& twin, pipeline::TappedUnit& unit, const accel::Image& image, const std::vector<float>& best_t) {
  if (twin.slot_o >= unit.state().contexts.count()) return;
  const pipeline::ExecSource::Registers& r = unit.state().source.registers(twin.slot_o);
  BitWriter origin(&twin.ray_origin_i[0]), direction(&twin.ray_direction_i[0]), centre(&twin.centre_i[0]);
  for (int axis = 0; axis < 3; ++axis) {
    origin.put(r.ray.ray.origin[axis]);
    direction.put(r.ray.ray.direction[axis]);
  }
  twin.ray_tmin_i = bits(r.ray.ray.tmin);
  twin.best_t_i = bits(best_t[twin.slot_o]);
  if (!accel::is_leaf(r.step.ref) || twin.index_o >= accel::leaf_count(r.step.ref)) return;
  const accel::LeafTriangle primitive = accel::read_triangle(image, accel::leaf_first(r.step.ref) + twin.index_o);
  for (int axis = 0; axis < 3; ++axis) centre.put(primitive.v0[axis]);
  twin.radius_i = bits(primitive.v1.x);
}

/// The twin beside the model's stage for one run.
template <class Model>
Compared compare(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed) {
  VerilatedContext context;
  Model twin(from_noise(context));
  reset(twin);
  StageRun run(world, config, stall_seed);
  auto& stage = *run.unit().stages().sphere_test;
  std::vector<float> best_t(1u << kSlotBits);
  Difference difference;
  Compared compared;
  const cosim::TokenWidths widths{.slot = kSlotBits};
  compared.difference = run.first_difference([&] {
    twin.tested_valid_i = stage.tested.valid;
    const cosim::TokenBits in = cosim::bits_of(stage.tested.token, widths);
    for (int word = 0; word < cosim::kTokenWords; ++word) twin.tested_data_i[word] = in[static_cast<std::size_t>(word)];
    twin.outcome_ready_i = stage.outcome.ready;
    twin.eval();
    answer(twin, run.unit(), world.image(), best_t);
    twin.eval();
    difference.same("tested pop", twin.tested_pop_o, stage.tested.popped)
        .same("outcome push", twin.outcome_push_o, stage.outcome.pushed)
        .same("activity", twin.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.outcome.pushed) {
      const cosim::TokenBits out = cosim::bits_of(stage.outcome.token, widths);
      for (int word = 0; word < cosim::kTokenWords; ++word)
        difference.same("outcome word", twin.outcome_data_o[word], out[static_cast<std::size_t>(word)]);
      compared.hits += stage.outcome.token.hit;
    }
    compared.spheres += stage.tested.popped && stage.tested.token.is_sphere();
    compared.outcomes += stage.outcome.pushed;
    clock(twin);
    for (int slot = 0; slot < run.unit().state().contexts.count(); ++slot)
      best_t[static_cast<std::size_t>(slot)] =
          run.unit().state().source.registers(static_cast<pipeline::Slot>(slot)).best.t;
    return difference.take();
  });
  return compared;
}

const test::World& scene() {
  static const test::World world = [] {
    scene::Mesh mesh = scene::load("gen:tilted-quads?quads=100").mesh;
    test::add_spheres(mesh);
    return test::World(accel::build(mesh, {}), cull::Design::None, 400);
  }();
  return world;
}

template <class Model>
void expect_equal(int latency) {
  SCOPED_TRACE(oracle::seed_note());
  for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed(), oracle::test_seed() + 1}) {
    pipeline::UnitConfig config = scene().config();
    config.ray_setup.interval = 1;
    config.sphere_test.latency = latency;
    const Compared compared = compare<Model>(scene(), config, stall_seed);
    EXPECT_EQ(compared.difference, "") << "latency " << latency << ", stall seed " << stall_seed;
    EXPECT_EQ(compared.outcomes, scene().counts().triangle_tests);
    EXPECT_GT(compared.spheres, 200u);
    EXPECT_LT(compared.spheres, compared.outcomes);
    EXPECT_GT(compared.hits, 50u);
  }
}

TEST(SphereTest, equals_the_model_in_every_cycle_at_latency_89) { expect_equal<VSphereTest89>(89); }
TEST(SphereTest, equals_the_model_in_every_cycle_at_latency_21) { expect_equal<VSphereTest21>(21); }
TEST(SphereTest, equals_the_model_in_every_cycle_at_latency_1) { expect_equal<VSphereTest1>(1); }

}  // namespace
}  // namespace ctu::rtl
