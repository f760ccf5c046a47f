// rtl/hit_update.sv against the model's hit_update within a unit at work, in every cycle; and its choice of the better
// hit against intersect::replaces on numbers that tie, differ by a bit, or are zeros of both signs.
#include <array>
#include <random>

#include "VHitUpdate.h"
#include "VHitUpdate1.h"
#include "VHitUpdate5.h"
#include "VMutantHitBeforeUpdate.h"
#include "VMutantHitLaterWins.h"
#include "model/numeric/round.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using intersect::Hit;
using numeric::bits;

constexpr int kSlotBits = 5;

template <class Model>
void set_tested(Model& twin, const pipeline::ComputedTest& test) {
  BitWriter(&twin.tested_data_i[0])
      .put(test.candidate.primitive, 32)
      .put(test.hit ? test.candidate.v : 0)
      .put(test.hit ? test.candidate.u : 0)
      .put(test.hit ? test.candidate.t : 0)
      .put(test.hit, 1)
      .put(test.last, 1)
      .put(test.index, 4)
      .put(test.slot, kSlotBits);
}

template <class Model>
void set_best(Model& twin, const Hit& best, bool any_hit) {
  twin.best_t_i = bits(best.t);
  twin.best_primitive_i = best.primitive;
  twin.best_any_hit_i = any_hit;
}

/// What the twin's write leaves of a best hit.
template <class Model>
Hit written(const Model& twin, const Hit& before) {
  if (!twin.best_write_o) return before;
  return {std::bit_cast<float>(twin.best_t_o), std::bit_cast<float>(twin.best_u_o), std::bit_cast<float>(twin.best_v_o),
          twin.best_primitive_o};
}

struct Compared {
  std::string difference;
  std::uint64_t writes = 0, finished = 0;
};

/// The twin beside the model's stage for one run.
template <class Model>
Compared compare(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed) {
  VerilatedContext context;
  Model twin(from_noise(context));
  reset(twin);
  StageRun run(world, config, stall_seed);
  auto& stage = run.unit().stages().hit_update;
  auto& state = run.unit().state();
  std::vector<Hit> best(static_cast<std::size_t>(config.unit.contexts));  // as at the start of the cycle
  Difference difference;
  Compared compared;
  compared.difference = run.first_difference([&] {
    const pipeline::ComputedTest& test = stage.tested.token;
    twin.tested_valid_i = stage.tested.valid;
    set_tested(twin, test);
    set_best(twin, best[test.slot], state.contexts[test.slot].any_hit);
    twin.done_ready_i = stage.done.ready;
    twin.eval();
    difference.same("tested pop", twin.tested_pop_o, stage.tested.popped)
        .same("done push", twin.done_push_o, stage.done.pushed)
        .same("activity", twin.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.done.pushed)
      difference.same("done", twin.done_data_o, stage.done.token.slot << 1 | stage.done.token.finished);
    if (stage.tested.popped) {
      const Hit& after = state.source.registers(test.slot).best;
      const Hit twin_after = written(twin, best[test.slot]);
      difference.same("slot of the best hit", twin.best_slot_o, test.slot)
          .same("best hit written", twin.best_write_o, !intersect::same_bits(best[test.slot], after))
          .same("t", bits(twin_after.t), bits(after.t))
          .same("u", bits(twin_after.u), bits(after.u))
          .same("v", bits(twin_after.v), bits(after.v))
          .same("primitive", twin_after.primitive, after.primitive);
    } else {
      difference.same("best hit written without an outcome", twin.best_write_o, 0);
    }
    compared.writes += twin.best_write_o;
    compared.finished += twin.done_push_o && (twin.done_data_o & 1) != 0;
    for (std::size_t slot = 0; slot < best.size(); ++slot)
      best[slot] = state.source.registers(static_cast<pipeline::Slot>(slot)).best;
    clock(twin);
    return difference.take();
  });
  return compared;
}

const test::World& world() {
  static const test::World world("gen:tilted-quads?quads=2000", cull::Design::None, 600);
  return world;
}

pipeline::UnitConfig config_of(int latency) {
  pipeline::UnitConfig config = world().config();
  config.hit_update.latency = latency;
  config.triangle_test.latency = 1 + latency;  // outcomes of a leaf overtake the tests of its last triangles
  return config;
}

template <class Model>
void expect_equal(int latency) {
  for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed(), oracle::test_seed() + 1}) {
    const Compared compared = compare<Model>(world(), config_of(latency), stall_seed);
    EXPECT_EQ(compared.difference, "") << "latency " << latency << ", stall seed " << stall_seed;
    EXPECT_GT(compared.writes, 50u);
    EXPECT_GT(compared.finished, 5u);
  }
}

TEST(HitUpdate, equals_the_model_in_every_cycle_at_every_latency) {
  SCOPED_TRACE(oracle::seed_note());
  expect_equal<VHitUpdate1>(1);
  expect_equal<VHitUpdate>(2);
  expect_equal<VHitUpdate5>(5);
}

/// Outcomes and best hits of few values that lie close together, against intersect::replaces; the first difference.
template <class Model>
std::string compare_choices(int cases) {
  constexpr std::array<float, 8> kTimes = {0.0f,   -0.0f,   1.0f,  0x1.000002p0f,
                                           1e-45f, -1e-45f, 3e38f, std::numeric_limits<float>::infinity()};
  constexpr std::array<std::uint32_t, 5> kPrimitives = {0, 1, 0x7fffffffu, 0x80000000u, 0xfffffffeu};
  VerilatedContext context;
  Model twin(from_noise(context));
  reset(twin);
  std::mt19937_64 random(oracle::test_seed());
  Difference difference;
  const auto time = [&] {
    return random() % 4 == 0 ? std::bit_cast<float>(static_cast<std::uint32_t>(random()) & 0xff7fffffu)
                             : kTimes[random() % kTimes.size()];
  };
  for (int i = 0; i < cases; ++i) {
    const Hit best{time(), 0.25f, 0.5f,
                   random() % 4 == 0 ? intersect::kNoPrimitive : kPrimitives[random() % kPrimitives.size()]};
    const Hit candidate{time(), 0.5f, 0.125f, kPrimitives[random() % kPrimitives.size()]};
    const pipeline::ComputedTest test{static_cast<pipeline::Slot>(random() % 32), 0, true, random() % 8 != 0,
                                      candidate};
    const bool any_hit = random() % 2 == 0;
    set_tested(twin, test);
    set_best(twin, best, any_hit);
    twin.tested_valid_i = true;
    twin.done_ready_i = true;
    twin.eval();
    const bool replaced = test.hit && intersect::replaces(candidate.t, candidate.primitive, best);
    difference.same("best hit written", twin.best_write_o, replaced);
    const Hit after = replaced ? candidate : best, twin_after = written(twin, best);
    difference.same("t", bits(twin_after.t), bits(after.t)).same("primitive", twin_after.primitive, after.primitive);
    clock(twin);
    twin.tested_valid_i = false;
    for (int cycle = 0; cycle < 8 && !twin.done_push_o; ++cycle) clock(twin);
    const bool finished = any_hit && after.primitive != intersect::kNoPrimitive;
    difference.same("done", twin.done_data_o, test.slot << 1 | finished);
    clock(twin);
    const std::string found = difference.take();
    char text[128];
    std::snprintf(text, sizeof text, "best %08x of %u, outcome %08x of %u, hit %d: ", bits(best.t), best.primitive,
                  bits(candidate.t), candidate.primitive, test.hit);
    if (!found.empty()) return text + found;
  }
  return "";
}

TEST(HitUpdate, takes_the_hit_that_the_model_takes_on_ties_zeros_and_neighbours) {
  SCOPED_TRACE(oracle::seed_note());
  EXPECT_EQ(compare_choices<VHitUpdate>(50'000), "");
}

TEST(HitUpdateMutants, a_later_hit_of_equal_t_taken_whatever_its_primitive_is_caught) {
  SCOPED_TRACE(oracle::seed_note());
  EXPECT_NE(compare_choices<VMutantHitLaterWins>(1000), "");
}
TEST(HitUpdateMutants, a_finish_judged_before_the_update_is_caught) {
  SCOPED_TRACE(oracle::seed_note());
  EXPECT_NE(compare<VMutantHitBeforeUpdate>(world(), config_of(2), 0).difference, "");
}

}  // namespace
}  // namespace ctu::rtl
