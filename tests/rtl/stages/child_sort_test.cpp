// rtl/child_sort.sv against the model's child_sort within a unit at work, in every cycle; and its order against that of
// (t0, lane) for every set of survivors and every way in which four t0 can order, tie or be zeros of both signs.
#include <algorithm>
#include <array>
#include <bit>

#include "VChildSort.h"
#include "VChildSort1.h"
#include "VChildSort2.h"
#include "VChildSort7.h"
#include "VMutantSortDeadCount.h"
#include "VMutantSortLaneTies.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

constexpr int kLanes = intersect::kLanes;

std::uint32_t bits_of(const pipeline::NodeToken& token) {
  std::uint32_t bits = 0;
  BitWriter(&bits)
      .put(token.asked, 4)
      .put(token.order, 8)
      .put(token.survivors, 4)
      .put(token.hits, 4)
      .put(token.slot, 5);
  return bits;
}

template <class Model>
void set_times(Model& twin, const float (&t0)[kLanes]) {
  BitWriter writer(&twin.times_t0_i[0]);
  for (const float t : t0) writer.put(t);
}

struct Compared {
  std::string difference;
  std::uint64_t nodes = 0, sorted = 0;  ///< sorted: with two survivors or more
};

/// The twin beside the model's stage for one run.
template <class Model>
Compared compare(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed) {
  VerilatedContext context;
  Model twin(from_noise(context));
  reset(twin);
  StageRun run(world, config, stall_seed);
  auto& stage = run.unit().stages().child_sort;
  auto& source = run.unit().state().source;
  Difference difference;
  Compared compared;
  compared.difference = run.first_difference([&] {
    const pipeline::NodeToken& token = stage.survivors.token;
    twin.survivors_valid_i = stage.survivors.valid;
    twin.survivors_data_i = bits_of(token);
    set_times(twin, source.registers(token.slot).times.t0);
    twin.sorted_ready_i = stage.sorted.ready;
    twin.eval();
    difference.same("survivors pop", twin.survivors_pop_o, stage.survivors.popped)
        .same("sorted push", twin.sorted_push_o, stage.sorted.pushed)
        .same("activity", twin.activity_o, static_cast<unsigned>(stage.account.current()));
    if (stage.survivors.popped) difference.same("slot of the times", twin.times_slot_o, token.slot);
    if (stage.sorted.pushed) difference.same("sorted", twin.sorted_data_o, bits_of(stage.sorted.token));
    compared.nodes += stage.survivors.popped;
    compared.sorted += stage.survivors.popped && std::popcount(token.survivors) > 1;
    clock(twin);
    return difference.take();
  });
  return compared;
}

template <class Model>
void expect_equal(int latency) {
  for (const cull::Design design : {cull::Design::None, cull::Design::Projection}) {
    const test::World world("gen:tilted-quads?quads=200", design, 150);
    pipeline::UnitConfig config = world.config();
    config.child_sort.latency = latency;
    for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed(), oracle::test_seed() + 1}) {
      const Compared compared = compare<Model>(world, config, stall_seed);
      EXPECT_EQ(compared.difference, "") << "latency " << latency << ", stall seed " << stall_seed;
      EXPECT_EQ(compared.nodes, world.counts().node_visits);
      EXPECT_GT(compared.sorted, 50u);
    }
  }
}

TEST(ChildSort, equals_the_model_in_every_cycle_at_every_latency) {
  SCOPED_TRACE(oracle::seed_note());
  expect_equal<VChildSort1>(1);
  expect_equal<VChildSort2>(2);
  expect_equal<VChildSort>(3);
  expect_equal<VChildSort7>(7);
}

/// The order by definition: survivors sorted by (t0, lane).
std::uint8_t order_of(unsigned survivors, const float (&t0)[kLanes]) {
  std::array<int, kLanes> lanes = {};
  int count = 0;
  for (int lane = 0; lane < kLanes; ++lane)
    if ((survivors >> lane & 1) != 0) lanes[static_cast<std::size_t>(count++)] = lane;
  std::stable_sort(lanes.begin(), lanes.begin() + count, [&](int a, int b) { return t0[a] < t0[b]; });
  unsigned order = 0;
  for (int place = 0; place < count; ++place)
    order |= static_cast<unsigned>(lanes[static_cast<std::size_t>(place)]) << 2 * place;
  return static_cast<std::uint8_t>(order);
}

/// Every set of survivors with every choice of four from numbers of every kind; the first difference. Tokens enter
/// every cycle, so the order of one is also that of its cycle.
template <class Model>
std::string compare_orders(int latency) {
  constexpr std::array<float, 8> kTimes = {-3e38f, -1e-45f, -0.0f, 0.0f, 1.0f, 0x1.000002p0f, 2.0f, HUGE_VALF};
  VerilatedContext context;
  Model twin(from_noise(context));
  reset(twin);
  Difference difference;
  std::vector<pipeline::NodeToken> entered;
  for (unsigned choice = 0; choice < 16 * 8 * 8 * 8 * 8; ++choice) {
    const unsigned survivors = choice & 15;
    float t0[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) t0[lane] = kTimes[choice >> (4 + 3 * lane) & 7];
    pipeline::NodeToken token{static_cast<pipeline::Slot>(choice % 29), 15, static_cast<std::uint8_t>(survivors), 0xa5,
                              7};
    twin.survivors_valid_i = true;
    twin.survivors_data_i = bits_of(token);
    twin.sorted_ready_i = true;
    set_times(twin, t0);
    twin.eval();
    token.order = order_of(survivors, t0);
    token.asked = 0;
    entered.push_back(token);
    const std::size_t last = static_cast<std::size_t>(latency);
    if (choice >= last) difference.same("sorted", twin.sorted_data_o, bits_of(entered[choice - last]));
    const std::string found = difference.take();
    if (!found.empty()) return "token " + std::to_string(choice - last) + ": " + found;
    clock(twin);
  }
  return "";
}

TEST(ChildSort, orders_every_set_of_survivors_by_t0_and_lane_however_they_tie) {
  EXPECT_EQ(compare_orders<VChildSort>(3), "");
  EXPECT_EQ(compare_orders<VChildSort1>(1), "");
}
TEST(ChildSortMutants, the_higher_lane_first_at_equal_t0_is_caught) {
  EXPECT_NE(compare_orders<VMutantSortLaneTies>(3), "");
}
TEST(ChildSortMutants, places_that_count_lanes_which_did_not_survive_are_caught) {
  EXPECT_NE(compare_orders<VMutantSortDeadCount>(3), "");
}

}  // namespace
}  // namespace ctu::rtl
