// A Verilated mask_test beside the model's in a run of the whole unit.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/rtl/stages/fetched_rows.h"
#include "tests/rtl/stages/ports.h"

namespace ctu::rtl {

template <class Model>
class MaskTestTwin {
 public:
  MaskTestTwin(const test::World& world, const pipeline::UnitConfig& config, std::uint64_t stall_seed)
      : world_(world), config_(config), rows_(world, config), run_(world, config, stall_seed) {}

  /// What the run has seen, for tests that want it to have seen something.
  struct Seen {
    std::string difference;  ///< the first one with its cycle, where the run ended; empty: none
    std::uint64_t nodes = 0, asked = 0, conflicts = 0, blocked = 0;
  };

  Seen run() {
    model_.located_valid_i = model_.load_valid_i = 0;
    reset(model_);
    if (config_.table_cache.bytes == 0) load_tables();
    auto& unit = run_.unit();
    while (!unit.done() && seen_.difference.empty()) {
      unit.step();
      drive();
      compare();
      clock(model_);
    }
    return seen_;
  }

 private:
  static constexpr int kSlotBits = 5;
  using Words = std::vector<std::uint32_t>;

  auto& stage() { return *run_.unit().stages().mask_test; }

  const cull::TableContent& content() const { return rows_.content(); }

  void load_tables() {
    Words data(words_of<std::remove_reference_t<decltype(model_.load_data_i)>>());
    model_.load_valid_i = 1;
    for (std::size_t table = 0; table < content().tables().size(); ++table)
      for (std::uint64_t row = 0; row < content().tables()[table].rows; ++row) {
        model_.load_table_i = static_cast<std::uint8_t>(table);
        model_.load_row_i = static_cast<std::uint32_t>(row);
        const std::uint64_t* const bits = content().row(table, row);
        for (std::size_t word = 0; word < 2 * content().words(table) && word < data.size(); ++word)
          data[word] = static_cast<std::uint32_t>(bits[word / 2] >> (32 * (word % 2)));
        set_port(model_.load_data_i, data);
        clock(model_);
      }
    model_.load_valid_i = 0;
  }

  void drive() {
    model_.located_valid_i = stage().located.valid;
    const pipeline::NodeToken& token = stage().located.token;
    model_.located_data_i = node_bits(token);
    model_.survivors_ready_i = stage().survivors.ready;
    model_.eval();
    // The register files answer in the same cycle.
    set_port(model_.key_i, key_words(model_.key_slot_o));
    set_port(model_.mask_i, mask_words(model_.mask_slot_o));
    if (config_.table_cache.bytes > 0) set_port(model_.row_i, row_words(model_.row_slot_o));
    model_.eval();
  }

  void compare() {
    difference_.same("left_out", model_.left_out_o, 0)
        .same("located pop", model_.located_pop_o, stage().located.popped)
        .same("survivors push", model_.survivors_push_o, stage().survivors.pushed)
        .same("activity", model_.activity_o, static_cast<std::uint64_t>(stage().account.current()));
    if (stage().survivors.pushed)
      difference_.same("survivors", model_.survivors_data_o, node_bits(stage().survivors.token));
    seen_.difference = difference_.take();
    if (!seen_.difference.empty()) seen_.difference += ", cycle " + std::to_string(run_.unit().cycles() - 1);
    seen_.nodes += stage().located.popped;
    seen_.asked += stage().located.popped && stage().located.token.asked != 0;
    seen_.conflicts += stage().account.current() == pipeline::Activity::BankConflict;
    seen_.blocked += stage().account.current() == pipeline::Activity::OutputFull;
  }

  static std::uint32_t node_bits(const pipeline::NodeToken& token) {
    return static_cast<std::uint32_t>(token.slot) << 20 | static_cast<std::uint32_t>(token.hits) << 16 |
           static_cast<std::uint32_t>(token.survivors) << 12 | static_cast<std::uint32_t>(token.order) << 4 |
           token.asked;
  }

  const pipeline::ExecSource::Registers* registers(unsigned slot) {
    const bool is_there = slot < static_cast<unsigned>(config_.unit.contexts);
    return is_there ? &run_.unit().state().source.registers(static_cast<pipeline::Slot>(slot)) : nullptr;
  }

  Words key_words(unsigned slot) {
    Words words(words_of<std::remove_reference_t<decltype(model_.key_i)>>());
    BitWriter writer(words.data());
    const auto* const r = registers(slot);
    const std::uint32_t r3 = mask_bits();
    for (int lane = 0; r != nullptr && lane < intersect::kLanes; ++lane) {
      if (config_.mask_test.design == cull::Design::Comparators)
        put(writer, r->touched[lane], r3);
      else
        writer.put(r->key[lane], 30).put(r->key[lane] >> 31, 1);
    }
    return words;
  }

  Words mask_words(unsigned slot) {
    Words words(words_of<std::remove_reference_t<decltype(model_.mask_i)>>());
    BitWriter writer(words.data());
    const auto* const r = registers(slot);
    for (int lane = 0; r != nullptr && lane < intersect::kLanes; ++lane)
      put(writer, object_mask(world_.image(), *r, lane).data(), world_.image().layout.mask_bits);
    return words;
  }

  Words row_words(unsigned slot) {
    Words words(words_of<std::remove_reference_t<decltype(model_.row_i)>>());
    BitWriter writer(words.data());
    const auto* const r = registers(slot);
    for (int lane = 0; r != nullptr && lane < intersect::kLanes; ++lane) rows_.put_lane(writer, *r, lane);
    return words;
  }

  std::uint32_t mask_bits() const {
    const auto r = static_cast<std::uint32_t>(world_.tester().options().resolution);
    return r * r * r;
  }

  const test::World& world_;
  pipeline::UnitConfig config_;
  FetchedRows rows_;
  StageRun run_;
  VerilatedContext context_;
  Model model_{from_noise(context_)};
  Seen seen_;
  Difference difference_;
};

}  // namespace ctu::rtl
