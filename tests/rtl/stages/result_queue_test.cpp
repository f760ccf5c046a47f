// rtl/result_queue.sv against the model's result_queue within a unit at work: every handshake, return and account in
// every cycle.
#include "VMutantResultIntervalLate.h"
#include "VMutantResultRaysFirst.h"
#include "VResultQueue.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

struct Compared {
  std::string difference;
  std::uint64_t returns = 0, from_rays = 0;
};

/// The twin beside the model's stage for one run.
template <class Model>
Compared compare(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed) {
  VerilatedContext context;
  Model twin(from_noise(context));
  twin.interval_i = static_cast<unsigned short>(config.result.interval);
  reset(twin);
  StageRun run(world, config, stall_seed);
  auto& stage = run.unit().stages().result_queue;
  Difference difference;
  Compared compared;
  compared.difference = run.first_difference([&] {
    twin.from_stack_valid_i = stage.from_stack.valid;
    twin.from_stack_data_i = static_cast<unsigned char>(stage.from_stack.token.slot);
    twin.from_rays_valid_i = stage.from_rays.valid;
    twin.from_rays_data_i = static_cast<unsigned char>(stage.from_rays.token.slot);
    twin.freed_ready_i = stage.freed.ready;
    twin.eval();
    difference.same("from_stack pop", twin.from_stack_pop_o, stage.from_stack.popped)
        .same("from_rays pop", twin.from_rays_pop_o, stage.from_rays.popped)
        .same("freed push", twin.freed_push_o, stage.freed.pushed)
        .same("return", twin.return_valid_o, stage.freed.pushed)
        .same("activity", twin.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.freed.pushed)
      difference.same("freed", twin.freed_data_o, stage.freed.token.slot)
          .same("slot returned", twin.return_slot_o, stage.freed.token.slot);
    compared.returns += twin.return_valid_o;
    compared.from_rays += twin.from_rays_pop_o;
    clock(twin);
    return difference.take();
  });
  return compared;
}

/// One ray in five is not accepted and comes straight from ray_queue.
const test::World& world() {
  static const test::World world = [] {
    std::vector<intersect::Ray> rays(400, test::ray_through_leaves());
    for (std::size_t i = 0; i < rays.size(); i += 5) rays[i] = {};
    return test::World(test::stacked_leaves(2, 3), cull::Design::None, rays);
  }();
  return world;
}

pipeline::UnitConfig config_of(int interval) {
  pipeline::UnitConfig config = world().config();
  config.ray_setup.interval = 1;
  config.result.interval = interval;
  return config;
}

TEST(ResultQueue, returns_rays_in_the_model_s_cycles_at_every_interval) {
  SCOPED_TRACE(oracle::seed_note());
  for (const int interval : {1, 2, 3, 8, 50, 1000}) {
    for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed(), oracle::test_seed() + 1}) {
      const Compared compared = compare<VResultQueue>(world(), config_of(interval), stall_seed);
      EXPECT_EQ(compared.difference, "") << "interval " << interval << ", stall seed " << stall_seed;
      EXPECT_EQ(compared.returns, world().rays());
      EXPECT_EQ(compared.from_rays, world().rays() / 5);
    }
  }
}

template <class Model>
void expect_caught() {
  EXPECT_NE(compare<Model>(world(), config_of(8), oracle::test_seed()).difference, "");
}
TEST(ResultQueueMutants, rays_never_accepted_going_before_finished_ones_are_caught) {
  expect_caught<VMutantResultRaysFirst>();
}
TEST(ResultQueueMutants, an_interval_of_one_cycle_more_is_caught) { expect_caught<VMutantResultIntervalLate>(); }

}  // namespace
}  // namespace ctu::rtl
