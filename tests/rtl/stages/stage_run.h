// A Verilated stage beside the model's: what the model's stage sees on its links in every cycle is what the twin sees,
// and what the twin does must be what the model's stage did in that cycle.
#pragma once

#include <gtest/gtest.h>
#include <verilated.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "model/pipeline/tapped_unit.h"
#include "sim/cosim/bit_fields.h"
#include "tests/oracle/seed.h"
#include "tests/pipeline/world.h"

namespace ctu::rtl {

using cosim::BitWriter;
using pipeline::Cycle;

/// The run of a whole unit over a world's rays, cycle by cycle.
class StageRun {
 public:
  /// `stall_seed` not 0: every link refuses at random.
  StageRun(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed)
      : StageRun(world, world.image(), config, stall_seed) {}
  /// The same over another image of the world.
  StageRun(const test::World& world, const accel::Image& image, const pipeline::UnitConfig& config,
           std::uint64_t stall_seed)
      : feed_(world.blocks(), world.packets()), unit_(config, {image, world.tester(), feed_}, {.seed = stall_seed}) {}

  pipeline::TappedUnit& unit() { return unit_; }

  /// Steps the model to its end; behind each cycle `compare(cycle)` drives the twin with the sampled ports and
  /// compares. Ends early at the first failure, which is reported with its cycle.
  void each_cycle(const std::function<void(Cycle)>& compare) {
    while (!unit_.done()) {
      const Cycle now = unit_.cycles();
      ASSERT_LT(now, kLongest) << "the model does not end";
      unit_.step();
      compare(now);
      ASSERT_FALSE(testing::Test::HasFailure()) << "in cycle " << now;
    }
  }

  /// Like each_cycle, for twins that may be broken on purpose: `difference()` tells what differs in the cycle, nothing
  /// when nothing does, and the first one is returned with its cycle.
  std::string first_difference(const std::function<std::string()>& difference) {
    while (!unit_.done()) {
      const Cycle now = unit_.cycles();
      if (now >= kLongest) return "the model does not end";
      unit_.step();
      const std::string found = difference();
      if (!found.empty()) return "cycle " + std::to_string(now) + ": " + found;
    }
    return "";
  }

 private:
  static constexpr Cycle kLongest = 10'000'000;
  test::VectorFeed feed_;
  pipeline::TappedUnit unit_;
};

/// What differs between twin and model in a cycle: the first of several comparisons.
class Difference {
 public:
  Difference& same(const char* what, std::uint64_t twin, std::uint64_t model) {
    ++compared_;
    if (twin == model || !text_.empty()) return *this;
    char text[128];
    std::snprintf(text, sizeof text, "%s: twin 0x%llx, model 0x%llx", what, static_cast<unsigned long long>(twin),
                  static_cast<unsigned long long>(model));
    text_ = text;
    return *this;
  }
  /// The difference found since the last call, empty if none.
  std::string take() { return std::exchange(text_, {}); }
  std::uint64_t compared() const { return compared_; }

 private:
  std::string text_;
  std::uint64_t compared_ = 0;
};

/// For models verilated with --x-initial unique: registers hold noise until reset or first written.
inline VerilatedContext* from_noise(VerilatedContext& context) {
  context.randReset(2);
  context.randSeed(static_cast<int>(oracle::test_seed() % 0x7fffffffu) + 1);
  return &context;
}

/// Raises the clock once, after the inputs of a cycle have been looked at.
template <class Model>
void clock(Model& model) {
  model.clk_i = 1;
  model.eval();
  model.clk_i = 0;
  model.eval();
}

/// Two clocks in reset.
template <class Model>
void reset(Model& model) {
  model.clk_i = 0;
  model.rst_i = 1;
  for (int i = 0; i < 2; ++i) clock(model);
  model.rst_i = 0;
  model.eval();
}

/// Reads fields from a wide vector, lowest bits first.
class BitReader {
 public:
  explicit BitReader(const std::uint32_t* words) : words_(words) {}
  std::uint64_t take(int bits) {
    std::uint64_t value = 0;
    for (int i = 0; i < bits; ++i, ++at_) value |= static_cast<std::uint64_t>(words_[at_ / 32] >> (at_ & 31) & 1) << i;
    return value;
  }

 private:
  const std::uint32_t* words_;
  std::size_t at_ = 0;
};

}  // namespace ctu::rtl
