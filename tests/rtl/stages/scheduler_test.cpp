// rtl/scheduler.sv against the model's scheduler within a unit at work: every handshake and account in every cycle.
#include "VMutantSchedulerLowestFirst.h"
#include "VMutantSchedulerNodesFirst.h"
#include "VMutantSchedulerRaysFirst.h"
#include "VScheduler.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using pipeline::SchedulerPolicy;

constexpr int kSlotBits = 5;

std::uint64_t bits_of(const pipeline::RefToken& token) {
  return static_cast<std::uint64_t>(token.slot) << 32 | token.ref;
}

struct Compared {
  std::string difference;
  std::uint64_t issues = 0, full_cycles = 0, double_arrivals = 0;
};

/// The twin beside the model's stage for one run.
template <class Model>
Compared compare(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed) {
  VerilatedContext context;
  Model twin(from_noise(context));
  twin.policy_round_robin_i = config.scheduler.policy == SchedulerPolicy::RoundRobin;
  reset(twin);
  StageRun run(world, config, stall_seed);
  auto& stage = run.unit().stages().scheduler;
  Difference difference;
  Compared compared;
  compared.difference = run.first_difference([&] {
    twin.from_stack_valid_i = stage.from_stack.valid;
    twin.from_stack_data_i = bits_of(stage.from_stack.token);
    twin.from_rays_valid_i = stage.from_rays.valid;
    twin.from_rays_data_i = bits_of(stage.from_rays.token);
    twin.to_node_fetch_ready_i = stage.to_node_fetch.ready;
    twin.to_leaf_fetch_ready_i = stage.to_leaf_fetch.ready;
    twin.eval();
    difference.same("from_stack pop", twin.from_stack_pop_o, stage.from_stack.popped)
        .same("from_rays pop", twin.from_rays_pop_o, stage.from_rays.popped)
        .same("to_node_fetch push", twin.to_node_fetch_push_o, stage.to_node_fetch.pushed)
        .same("to_leaf_fetch push", twin.to_leaf_fetch_push_o, stage.to_leaf_fetch.pushed)
        .same("activity", twin.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.to_node_fetch.pushed)
      difference.same("to_node_fetch", twin.to_node_fetch_data_o, bits_of(stage.to_node_fetch.token));
    if (stage.to_leaf_fetch.pushed)
      difference.same("to_leaf_fetch", twin.to_leaf_fetch_data_o, bits_of(stage.to_leaf_fetch.token));
    compared.issues += stage.to_node_fetch.pushed || stage.to_leaf_fetch.pushed;
    compared.full_cycles += stage.account.current() == pipeline::Activity::OutputFull;
    compared.double_arrivals += stage.from_stack.popped && stage.from_rays.popped;
    clock(twin);
    return difference.take();
  });
  return compared;
}

const test::World& world() {
  static const test::World world("gen:tilted-quads?quads=40", cull::Design::None, 300);
  return world;
}

pipeline::UnitConfig config_of(SchedulerPolicy policy, int contexts) {
  pipeline::UnitConfig config = world().config();
  config.scheduler.policy = policy;
  config.unit.contexts = contexts;
  config.ray_setup.interval = 1;
  config.node_cache.bytes = 2048;  // misses, so that fetches run full
  config.node_cache.mshrs = 2;
  return config;
}

TEST(Scheduler, issues_what_the_model_issues_in_every_cycle_under_both_policies) {
  SCOPED_TRACE(oracle::seed_note());
  std::uint64_t full_cycles = 0, double_arrivals = 0;
  for (const SchedulerPolicy policy : {SchedulerPolicy::Oldest, SchedulerPolicy::RoundRobin}) {
    for (const int contexts : {1, 2, 7, 1 << kSlotBits}) {
      for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed(), oracle::test_seed() + 1}) {
        const Compared compared = compare<VScheduler>(world(), config_of(policy, contexts), stall_seed);
        EXPECT_EQ(compared.difference, "")
            << contexts << " contexts, policy " << static_cast<int>(policy) << ", stall seed " << stall_seed;
        EXPECT_EQ(compared.issues, world().counts().node_visits + world().counts().leaf_visits);
        full_cycles += compared.full_cycles;
        double_arrivals += compared.double_arrivals;
      }
    }
  }
  EXPECT_GT(full_cycles, 100u);
  EXPECT_GT(double_arrivals, 100u);
}

template <class Model>
void expect_caught(SchedulerPolicy policy) {
  EXPECT_NE(compare<Model>(world(), config_of(policy, 7), oracle::test_seed()).difference, "");
}
TEST(SchedulerMutants, a_node_that_always_goes_before_an_older_leaf_is_caught) {
  expect_caught<VMutantSchedulerNodesFirst>(SchedulerPolicy::Oldest);
}
TEST(SchedulerMutants, rays_of_ray_queue_queued_before_those_of_the_stack_are_caught) {
  expect_caught<VMutantSchedulerRaysFirst>(SchedulerPolicy::Oldest);
}
TEST(SchedulerMutants, the_lowest_context_instead_of_the_next_in_turn_is_caught) {
  expect_caught<VMutantSchedulerLowestFirst>(SchedulerPolicy::RoundRobin);
}

}  // namespace
}  // namespace ctu::rtl
