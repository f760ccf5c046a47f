// rtl/traversal_stack.sv against pipeline::TraversalStack in a whole unit: every handshake and account of every cycle.
// What is spilled comes back only as what the twin wrote.
#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <sstream>
#include <unordered_map>

#include "VStackMutantKeptDepth.h"
#include "VStackMutantNearestFirst.h"
#include "VStackMutantNoTurns.h"
#include "VStackMutantRefillOldest.h"
#include "VTraversalStack.h"
#include "VTraversalStackNarrow.h"
#include "VTraversalStackNoSpills.h"
#include "VTraversalStackWide.h"
#include "model/numeric/round.h"
#include "model/pipeline/memory_map.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using pipeline::UnitConfig;

const test::World& world() {
  static const test::World made("gen:hair-ball?strands=600", cull::Design::None, 300);
  return made;
}

/// Memory behind the stack: takes the batches of writes, gives lines. What was never written is noise.
class SpillMemory {
 public:
  SpillMemory(int line_bytes, int batch_bytes) : line_words_(line_bytes / 4), batch_words_(batch_bytes / 4) {}

  void write(std::uint64_t address, const std::uint32_t* line) {
    for (std::uint64_t word = address / 4; word < address / 4 + batch_words_; ++word)
      words_[word] = line[word % line_words_];
  }
  void read(std::uint64_t address, std::uint32_t* line) {
    const std::uint64_t first = address / 4 / line_words_ * line_words_;
    for (std::uint64_t i = 0; i < line_words_; ++i) {
      const auto found = words_.find(first + i);
      line[i] = found == words_.end() ? static_cast<std::uint32_t>(noise_()) : found->second;
    }
  }

 private:
  std::uint64_t line_words_, batch_words_;
  std::unordered_map<std::uint64_t, std::uint32_t> words_;
  std::mt19937_64 noise_;
};

/// The twin, built for lines of kLineBytes.
template <class Model, int kLineBytes>
class StackTwin {
 public:
  StackTwin(const UnitConfig& config, pipeline::TappedUnit& unit)
      : unit_(unit),
        memory_(kLineBytes, 8 * config.stack.spill_batch),
        refill_address_(static_cast<std::size_t>(config.unit.contexts)) {
    const pipeline::MemoryMap map(config, unit.state().image);
    model_.entries_i = static_cast<std::uint8_t>(config.stack.entries);
    model_.push_width_i = static_cast<std::uint8_t>(config.stack.push_width);
    model_.spill_batch_i = static_cast<std::uint8_t>(config.stack.spill_batch);
    model_.spill_base_i = static_cast<std::uint32_t>(map.spill_base);
    model_.spill_region_i = static_cast<std::uint32_t>(map.spill_region);
    reset(model_);
  }

  /// Behind a cycle of the unit: the same cycle of the twin. The first difference, or nothing.
  std::string cycle() {
    set_links();
    set_registers();
    model_.eval();
    difference_.str("");
    compare();
    move_spills();
    clock(model_);
    return difference_.str();
  }
  std::uint64_t refills() const { return refills_; }

 private:
  auto& stage() { return unit_.stages().traversal_stack; }

  void set_links() {
    auto& s = stage();
    const pipeline::NodeToken& node = s.sorted.token;
    model_.sorted_valid_i = s.sorted.valid;
    model_.sorted_data_i = static_cast<std::uint32_t>(node.slot) << 20 | static_cast<std::uint32_t>(node.hits) << 16 |
                           static_cast<std::uint32_t>(node.survivors) << 12 |
                           static_cast<std::uint32_t>(node.order) << 4 | node.asked;
    model_.leaf_done_valid_i = s.leaf_done.valid;
    model_.leaf_done_data_i = static_cast<std::uint16_t>(s.leaf_done.token.slot << 1 | s.leaf_done.token.finished);
    model_.refills_valid_i = s.refills.valid;
    if (s.refills.valid) {
      memory_.read(refill_address_[s.refills.token.id], &model_.refills_data_i[0]);
      model_.refills_data_i[kLineBytes / 4] = s.refills.token.id;
    }
    model_.to_scheduler_ready_i = s.to_scheduler.ready;
    model_.to_result_ready_i = s.to_result.ready;
    model_.spills_ready_i = s.spills.ready;
  }

  /// Nothing that a job needs changes until it ends.
  void set_registers() {
    if (model_.slot_o >= unit_.state().contexts.count()) return;
    const auto& registers = unit_.state().source.registers(model_.slot_o);
    const pipeline::UnitImage& image = unit_.state().image;
    for (int lane = 0; lane < 4; ++lane) {
      model_.t0_i[lane] = numeric::bits(registers.times.t0[lane]);
      model_.children_i[lane] = accel::is_inner(registers.step.ref) ? image.child(registers.step.ref, lane) : 0u;
    }
    model_.best_t_i = numeric::bits(registers.best.t);
  }

  void compare() {
    auto& s = stage();
    same("sorted_pop", model_.sorted_pop_o, s.sorted.popped);
    same("leaf_done_pop", model_.leaf_done_pop_o, s.leaf_done.popped);
    same("refills_pop", model_.refills_pop_o, s.refills.popped);
    same("to_scheduler_push", model_.to_scheduler_push_o, s.to_scheduler.pushed);
    same("to_result_push", model_.to_result_push_o, s.to_result.pushed);
    same("spills_push", model_.spills_push_o, s.spills.pushed);
    same("activity", model_.activity_o, static_cast<std::uint64_t>(s.account.current()));
    same("visit_valid", model_.visit_valid_o, s.sorted.popped);
    if (s.sorted.popped) same("visit_slot", model_.visit_slot_o, s.sorted.token.slot);
    if (s.to_scheduler.pushed)
      same("to_scheduler", model_.to_scheduler_data_o,
           static_cast<std::uint64_t>(s.to_scheduler.token.slot) << 32 | s.to_scheduler.token.ref);
    if (s.to_result.pushed) same("to_result", model_.to_result_data_o, s.to_result.token.slot);
    if (s.spills.pushed) {
      BitReader reader(&model_.spills_data_o[kLineBytes / 4]);
      same("spills.write", reader.take(1), s.spills.token.write);
      same("spills.id", reader.take(8), s.spills.token.id);
      same("spills.address", reader.take(32), s.spills.token.address);
    }
  }

  void move_spills() {
    const auto& spills = stage().spills;
    if (!spills.pushed) return;
    if (spills.token.write)
      memory_.write(spills.token.address, &model_.spills_data_o[0]);
    else
      refill_address_[spills.token.id] = spills.token.address;
    refills_ += !spills.token.write;
  }

  void same(const char* port, std::uint64_t twin, std::uint64_t model) {
    if (twin != model) difference_ << port << ": the twin 0x" << std::hex << twin << ", the model 0x" << model << "; ";
  }

  pipeline::TappedUnit& unit_;
  SpillMemory memory_;
  std::vector<std::uint64_t> refill_address_;
  std::ostringstream difference_;
  std::uint64_t refills_ = 0;
  VerilatedContext context_;
  Model model_{from_noise(context_)};
};

using Wide = StackTwin<VTraversalStackWide, 128>;
using Even = StackTwin<VTraversalStack, 128>;
using Narrow = StackTwin<VTraversalStackNarrow, 512>;
using NoSpills = StackTwin<VTraversalStackNoSpills, 128>;

UnitConfig config_of(int contexts, int entries, int push_width, int spill_batch, int line_bytes = 128) {
  UnitConfig config = world().config();
  config.unit.contexts = contexts;
  config.stack = {.entries = entries, .push_width = push_width, .spill_batch = spill_batch};
  config.memory.line_bytes = line_bytes;
  config.memory.model = pipeline::MemoryModel::Ideal;
  config.memory.latency = 20;
  config.memory.interval = 1;
  return config;
}

/// Whole runs of both, with free links and with links that refuse at random. How many batches came back.
template <class Twin>
std::uint64_t expect_equal(const UnitConfig& config) {
  std::uint64_t refills = 0;
  for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed()}) {
    SCOPED_TRACE(testing::Message() << config.unit.contexts << " contexts, " << config.stack.entries << " entries, "
                                    << config.stack.push_width << " a cycle, batches of " << config.stack.spill_batch
                                    << ", lines of " << config.memory.line_bytes << ", stall seed " << stall_seed);
    StageRun run(world(), config, stall_seed);
    Twin twin(config, run.unit());
    run.each_cycle([&](Cycle) { EXPECT_EQ(twin.cycle(), ""); });
    refills += twin.refills();
  }
  return refills;
}

TEST(TraversalStack, does_in_every_cycle_what_the_model_does_when_a_context_holds_several_lines) {
  EXPECT_GT(expect_equal<Wide>(config_of(1, 1, 1, 1)), 1000u);
  EXPECT_GT(expect_equal<Wide>(config_of(32, 1, 3, 1)), 1000u);
  EXPECT_GT(expect_equal<Wide>(config_of(32, 2, 2, 2)), 100u);
  EXPECT_GT(expect_equal<Wide>(config_of(7, 3, 3, 2)), 50u);
  EXPECT_GT(expect_equal<Wide>(config_of(20, 7, 1, 4)), 0u);
  expect_equal<Wide>(config_of(32, 16, 2, 16));
  expect_equal<Wide>(config_of(32, 64, 3, 8));
}

TEST(TraversalStack, does_so_when_a_context_holds_one_line) {
  EXPECT_GT(expect_equal<Even>(config_of(4, 2, 1, 1)), 100u);
  EXPECT_GT(expect_equal<Even>(config_of(3, 5, 3, 4)), 0u);
  expect_equal<Even>(config_of(4, 16, 3, 8));
}

TEST(TraversalStack, does_so_when_a_line_holds_several_contexts) {
  EXPECT_GT(expect_equal<Narrow>(config_of(50, 1, 2, 1, 512)), 1000u);
  EXPECT_GT(expect_equal<Narrow>(config_of(50, 2, 3, 2, 512)), 100u);
  EXPECT_GT(expect_equal<Narrow>(config_of(50, 4, 3, 4, 512)), 10u);
}

TEST(TraversalStack, needs_no_memory_when_no_ray_can_hold_more_than_there_is) {
  const UnitConfig config = config_of(8, 64, 2, 8);
  ASSERT_FALSE(StageRun(world(), config, 0).unit().state().has_spills);
  expect_equal<NoSpills>(config);
  expect_equal<NoSpills>(config_of(5, 60, 1, 8));
  expect_equal<NoSpills>(config_of(8, 64, 3, 8));
}

template <class Model>
void expect_caught() {
  const UnitConfig config = config_of(4, 3, 2, 2);
  StageRun run(world(), config, oracle::test_seed());
  StackTwin<Model, 128> twin(config, run.unit());
  std::string difference;
  while (!run.unit().done() && difference.empty()) {
    run.unit().step();
    difference = twin.cycle();
  }
  EXPECT_NE(difference, "");
  std::cout << "cycle " << run.unit().cycles() - 1 << ", " << difference << '\n';
}

TEST(TraversalStackMutants, entries_left_behind_by_a_ray_are_caught) { expect_caught<VStackMutantKeptDepth>(); }
TEST(TraversalStackMutants, inputs_that_take_no_turns_are_caught) { expect_caught<VStackMutantNoTurns>(); }
TEST(TraversalStackMutants, the_nearest_child_pushed_first_is_caught) { expect_caught<VStackMutantNearestFirst>(); }
TEST(TraversalStackMutants, the_oldest_batch_read_back_first_is_caught) { expect_caught<VStackMutantRefillOldest>(); }

}  // namespace
}  // namespace ctu::rtl
