// rtl/cell_locate.sv against the model's cell_locate within a unit at work: every handshake, account, key and mask in
// every cycle.
#include <algorithm>
#include <bit>
#include <deque>

#include "VCellLocate1.h"
#include "VCellLocate2.h"
#include "VCellLocate4.h"
#include "VCellLocateMasks2.h"
#include "VCellLocateMasks3.h"
#include "VMutantCellLocateEntranceAlwaysFree.h"
#include "VMutantCellLocateFullLanesAsked.h"
#include "model/numeric/round.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/ports.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using numeric::bits;
using pipeline::NodeToken;
using pipeline::Slot;

constexpr int kSlotBits = 5;

std::uint32_t bits_of(const NodeToken& token) {
  return static_cast<std::uint32_t>(token.slot) << 20 | static_cast<std::uint32_t>(token.hits) << 16 |
         static_cast<std::uint32_t>(token.survivors) << 12 | static_cast<std::uint32_t>(token.order) << 4 | token.asked;
}

/// Bits [at, at + count) of a port.
template <class Port>
std::uint64_t bits_at(const Port& port, int at, int count) {
  const std::vector<std::uint32_t> words = get_port(port);
  std::uint64_t bits = 0;
  for (int i = 0; i < count; ++i) {
    const auto bit = static_cast<std::size_t>(at + i);
    bits |= static_cast<std::uint64_t>(words[bit / 32] >> (bit % 32) & 1) << i;
  }
  return bits;
}

/// How the twin was built.
struct Build {
  cull::Design design = cull::Design::Projection;
  cull::MaskOptions options;
  int units = 1, latency = 10;

  bool masks() const { return design == cull::Design::Comparators; }
  int key_bits() const { return masks() ? options.resolution * options.resolution * options.resolution : 31; }
};

/// A lane's key or mask that the twin must write.
struct Write {
  Cycle due = 0;  ///< in the pipeline's own time, which stands still while the output is full
  int unit = 0, lane = 0;
  Slot slot = 0;
};

struct Compared {
  std::string difference;
  std::uint64_t nodes = 0, writes = 0, unasked = 0, full_cycles = 0;
};

/// The twin beside the model's stage for one run.
template <class Model>
class Comparison {
 public:
  Comparison(const Build& build, const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed)
      : build_(build), run_(world, config, stall_seed), stage_(*run_.unit().stages().cell_locate) {
    reset(twin_);
  }

  Compared run() {
    compared_.difference = run_.first_difference([this] {
      drive();
      expect_writes();
      compare_handshakes();
      compare_writes();
      pipe_time_ += stands() ? 0 : 1;
      clock(twin_);
      return difference_.take();
    });
    return compared_;
  }

 private:
  bool stands() const { return stage_.account.current() == pipeline::Activity::OutputFull; }

  void drive() {
    twin_.tested_valid_i = stage_.tested.valid;
    twin_.tested_data_i = bits_of(stage_.tested.token);
    twin_.located_ready_i = stage_.located.ready;
    twin_.eval();
    drive_registers(static_cast<Slot>(twin_.context_slot_o));
    twin_.eval();
  }

  /// What a context's register files hold. Of a context that is not there, and of one that visits no node, anything.
  void drive_registers(Slot slot) {
    auto& state = run_.unit().state();
    if (slot >= state.contexts.count()) return;
    const auto& registers = state.source.registers(slot);
    if (accel::is_leaf(registers.step.ref)) return;
    const intersect::Box4& boxes = state.image.boxes(registers.step.ref);
    for (int axis = 0; axis < 3; ++axis) {
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        const int word = 4 * axis + lane;
        twin_.boxes_i[word] = bits(boxes.lo[axis][lane]);
        twin_.boxes_i[12 + word] = bits(boxes.hi[axis][lane]);
        twin_.times_near_down_i[word] = bits(registers.times.near_down[axis][lane]);
        twin_.times_near_up_i[word] = bits(registers.times.near_up[axis][lane]);
        twin_.times_far_down_i[word] = bits(registers.times.far_down[axis][lane]);
        twin_.times_far_up_i[word] = bits(registers.times.far_up[axis][lane]);
        twin_.times_t0_i[lane] = bits(registers.times.t0[lane]);
        twin_.times_t1_i[lane] = bits(registers.times.t1[lane]);
      }
      twin_.ray_origin_i[axis] = bits(registers.ray.ray.origin[axis]);
    }
    twin_.full_lanes_i = static_cast<std::uint8_t>(state.image.full_lanes(registers.step.ref));
    twin_.ray_zero_axes_i = registers.ray.zero_axes;
    twin_.ray_negative_axes_i = registers.ray.negative_axes;
  }

  /// The lanes of a node taken in this cycle: in their order, `units` a cycle.
  void expect_writes() {
    if (!stage_.tested.popped) return;
    const NodeToken& token = stage_.tested.token;
    auto& state = run_.unit().state();
    const unsigned asked = token.hits & ~state.image.full_lanes(state.source.registers(token.slot).step.ref);
    int place = 0;
    for (unsigned rest = asked; rest != 0; rest &= rest - 1, ++place) {
      const int cycle = place / build_.units;
      due_.push_back({pipe_time_ + static_cast<Cycle>(cycle + build_.latency), place % build_.units,
                      std::countr_zero(rest), token.slot});
    }
    ++compared_.nodes;
    compared_.unasked += static_cast<unsigned>(std::popcount(token.hits)) - static_cast<unsigned>(place);
  }

  void compare_handshakes() {
    difference_.same("tested pop", twin_.tested_pop_o, stage_.tested.popped)
        .same("located push", twin_.located_push_o, stage_.located.pushed)
        .same("activity", twin_.activity_o, static_cast<unsigned>(stage_.account.current()));
    if (stage_.located.pushed) difference_.same("located", twin_.located_data_o, bits_of(stage_.located.token));
    compared_.full_cycles += stands();
  }

  void compare_writes() {
    unsigned units = 0;
    for (; !stands() && !due_.empty() && due_.front().due == pipe_time_; due_.pop_front(), ++compared_.writes) {
      const Write& write = due_.front();
      units |= 1u << write.unit;
      difference_.same("key slot", twin_.key_slot_o, write.slot)
          .same("key lane", bits_at(twin_.key_lane_o, 2 * write.unit, 2), static_cast<unsigned>(write.lane));
      compare_key(write);
    }
    difference_.same("key write", twin_.key_write_o, units);
  }

  void compare_key(const Write& write) {
    const auto& registers = run_.unit().state().source.registers(write.slot);
    const int at = write.unit * build_.key_bits();
    if (!build_.masks()) {
      const std::uint32_t key = registers.key[write.lane];
      difference_.same("key", bits_at(twin_.key_o, at, 31), (key & 0x3fffffffu) | key >> 31 << 30);
      return;
    }
    for (int bit = 0; bit < build_.key_bits(); bit += 64) {
      const int count = std::min(64, build_.key_bits() - bit);
      difference_.same("mask", bits_at(twin_.key_o, at + bit, count), registers.touched[write.lane][bit / 64]);
    }
  }

  Build build_;
  StageRun run_;
  pipeline::CellLocate<pipeline::ExecSource, pipeline::TappedWiring>& stage_;
  VerilatedContext context_;
  Model twin_{&context_};
  std::deque<Write> due_;
  Cycle pipe_time_ = 0;
  Difference difference_;
  Compared compared_;
};

pipeline::UnitConfig config_of(const Build& build, const test::World& world, int contexts) {
  pipeline::UnitConfig config = world.config();
  config.unit.contexts = contexts;
  config.cell_locate.units = config.comparators.units = build.units;
  config.cell_locate.latency = config.comparators.latency = build.latency;
  return config;
}

test::World make_world(const Build& build) {
  return {"gen:tilted-quads?quads=150&size=0.6", build.design, 100, build.options};
}

/// With and without refusals, with contexts that keep the stage busy and with few.
template <class Model>
void expect_equal(const Build& build) {
  SCOPED_TRACE(oracle::seed_note());
  const test::World world = make_world(build);
  std::uint64_t full_cycles = 0, unasked = 0;
  for (const int contexts : {3, 1 << kSlotBits}) {
    for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed(), oracle::test_seed() + 1}) {
      const Compared compared = Comparison<Model>(build, world, config_of(build, world, contexts), stall_seed).run();
      EXPECT_EQ(compared.difference, "") << contexts << " contexts, stall seed " << stall_seed;
      EXPECT_EQ(compared.nodes, world.counts().node_visits);
      EXPECT_GT(compared.writes, compared.nodes / 4);
      full_cycles += compared.full_cycles;
      unasked += compared.unasked;
    }
  }
  EXPECT_GT(full_cycles, 100u);
  EXPECT_GT(unasked, 0u);
}

const Build kKeys1{.options = {.levels = 1}};
const Build kKeys2{.options = {.ray_resolution = 6, .levels = 1}, .units = 2, .latency = 1};
const Build kKeys4{.options = {.resolution = 3, .ray_resolution = 5, .levels = 1}, .units = 4, .latency = 23};
const Build kMasks3{.design = cull::Design::Comparators, .options = {.levels = 1}, .units = 3, .latency = 12};
const Build kMasks2{
    .design = cull::Design::Comparators, .options = {.resolution = 3, .levels = 1}, .units = 2, .latency = 3};

TEST(CellLocate, one_unit_of_keys_does_what_the_model_does_in_every_cycle) { expect_equal<VCellLocate1>(kKeys1); }
TEST(CellLocate, two_units_of_keys_of_latency_1) { expect_equal<VCellLocate2>(kKeys2); }
TEST(CellLocate, four_units_of_keys_of_latency_23) { expect_equal<VCellLocate4>(kKeys4); }
TEST(CellLocate, two_units_of_masks_of_latency_3) { expect_equal<VCellLocateMasks2>(kMasks2); }
TEST(CellLocate, three_units_of_masks) { expect_equal<VCellLocateMasks3>(kMasks3); }

template <class Model>
void expect_caught() {
  const test::World world = make_world(kKeys1);
  const Compared compared =
      Comparison<Model>(kKeys1, world, config_of(kKeys1, world, 1 << kSlotBits), oracle::test_seed()).run();
  EXPECT_NE(compared.difference, "");
}
TEST(CellLocateMutants, lanes_with_full_masks_that_are_asked_are_caught) {
  expect_caught<VMutantCellLocateFullLanesAsked>();
}
TEST(CellLocateMutants, an_entrance_left_after_one_cycle_is_caught) {
  expect_caught<VMutantCellLocateEntranceAlwaysFree>();
}

}  // namespace
}  // namespace ctu::rtl
