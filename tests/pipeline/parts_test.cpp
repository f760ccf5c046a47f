// The small parts of the unit, each against its timing diagram or closed form.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "model/base/error.h"
#include "model/pipeline/cache.h"
#include "model/pipeline/link.h"
#include "model/pipeline/memory_banked.h"
#include "model/pipeline/memory_ideal.h"
#include "model/pipeline/parameter.h"
#include "model/pipeline/pipe.h"
#include "model/pipeline/slot_set.h"
#include "model/pipeline/table_banks.h"

namespace ctu::pipeline {
namespace {

using cull::Design;

TEST(Link, what_is_pushed_in_a_cycle_can_be_popped_in_the_next_one_and_not_before) {
  Link<int> link;
  EXPECT_FALSE(link.can_pop(5));
  link.push(5, 42);
  EXPECT_FALSE(link.can_pop(5));
  ASSERT_TRUE(link.can_pop(6));
  EXPECT_EQ(link.front(), 42);
}

TEST(Link, room_made_by_a_pop_can_be_used_in_the_next_cycle_and_not_before) {
  Link<int> link;
  link.push(0, 1);
  link.push(1, 2);
  EXPECT_FALSE(link.can_push(2));
  link.pop(2);
  EXPECT_FALSE(link.can_push(2));
  EXPECT_TRUE(link.can_push(3));
}

TEST(Link, passes_one_token_every_cycle_in_order_whichever_side_steps_first) {
  for (const bool producer_first : {false, true}) {
    Link<Cycle> link;
    Cycle expected = 0;
    for (Cycle now = 0; now < 100; ++now) {
      const auto produce = [&] {
        ASSERT_TRUE(link.can_push(now));
        link.push(now, now);
      };
      if (producer_first) produce();
      if (link.can_pop(now)) {
        EXPECT_EQ(link.front(), expected++);
        link.pop(now);
      }
      if (!producer_first) produce();
    }
    EXPECT_EQ(expected, 99u);
  }
}

TEST(Pipe, a_token_leaves_latency_cycles_after_it_entered) {
  for (const int latency : {2, 11, 45, 100}) {
    Pipe<int> pipe(latency);
    pipe.enter(10, 7);
    EXPECT_FALSE(pipe.exit_ready(10 + static_cast<Cycle>(latency) - 1));
    EXPECT_TRUE(pipe.exit_ready(10 + static_cast<Cycle>(latency)));
    EXPECT_EQ(pipe.next_event(11), 10 + static_cast<Cycle>(latency));
  }
}

TEST(Pipe, a_frozen_pipe_keeps_the_distances_of_its_tokens) {
  Pipe<int> pipe(4);
  pipe.enter(0, 1);
  pipe.enter(3, 2);
  pipe.freeze(4);  // the first token cannot leave for five cycles
  pipe.freeze(6);
  EXPECT_EQ(pipe.leave(9), 1);
  EXPECT_FALSE(pipe.exit_ready(11));
  EXPECT_TRUE(pipe.exit_ready(12));  // three cycles behind the first, as at the entrance
}

TEST(Pipe, a_token_that_occupies_the_entrance_delays_the_next_one_and_itself) {
  Pipe<int> pipe(3);
  pipe.enter(0, 1, 4);
  EXPECT_FALSE(pipe.can_enter(3));
  EXPECT_TRUE(pipe.can_enter(4));
  EXPECT_FALSE(pipe.exit_ready(5));
  EXPECT_TRUE(pipe.exit_ready(6));
}

TEST(SlotSet, goes_round) {
  SlotSet set;
  for (const int slot : {3, 70, 255}) set.add(slot);
  EXPECT_EQ(set.next_from(0), 3);
  EXPECT_EQ(set.next_from(4), 70);
  EXPECT_EQ(set.next_from(71), 255);
  set.remove(255);
  EXPECT_EQ(set.next_from(71), 3);
}

TEST(CacheTags, evict_the_least_recently_used_line_of_the_set) {
  CacheTags tags({.bytes = 4 * 128, .ways = 2}, 128);  // 2 sets: lines of one parity share a set
  for (const LineNumber line : {0, 2}) tags.install(line);
  EXPECT_TRUE(tags.touch(0));
  tags.install(4);
  EXPECT_TRUE(tags.touch(0));
  EXPECT_FALSE(tags.touch(2));
  EXPECT_TRUE(tags.touch(4));
  EXPECT_EQ(tags.evictions(), 1u);
}

TEST(MissRegisters, merge_by_line_and_return_everyone_who_waits) {
  MissRegisters mshrs(2);
  const int a = mshrs.allocate(10);
  mshrs.wait(a, 3);
  mshrs.wait(mshrs.find(10), 5);
  mshrs.allocate(11);
  EXPECT_TRUE(mshrs.full());
  LineNumber line = 0;
  const SlotSet waiters = mshrs.release(a, line);
  EXPECT_EQ(line, 10u);
  EXPECT_TRUE(waiters.contains(3) && waiters.contains(5));
  EXPECT_EQ(waiters.count(), 2);
  EXPECT_EQ(mshrs.find(10), -1);
  EXPECT_FALSE(mshrs.full());
}

ClientRequest read_of(std::uint64_t address, std::uint16_t id = 0) { return {Client::NodeFetch, {address, id, false}}; }

TEST(IdealMemory, answers_at_its_latency_and_not_one_cycle_before) {
  MemoryConfig config;
  config.latency = 37;
  config.interval = 5;
  IdealMemory memory(config);
  memory.accept(100, read_of(0, 9));
  EXPECT_FALSE(memory.answer_ready(136));
  ASSERT_TRUE(memory.answer_ready(137));
  EXPECT_EQ(memory.answer().id, 9);
  EXPECT_FALSE(memory.can_accept(104));
  EXPECT_TRUE(memory.can_accept(105));
}

MemoryConfig banked(bool refresh) {
  MemoryConfig config;
  config.channels = 1;
  config.line_bytes = 64;
  config.row_bytes = 2048;
  config.front_latency = 20;
  config.burst = 5;
  config.t_rfc = refresh ? 280 : 0;
  return config;
}

/// Cycles from request to answer, alone in the memory.
Cycle latency_of(BankedMemory& memory, Cycle start, std::uint64_t address) {
  memory.accept(start, read_of(address));
  for (Cycle now = start;; ++now) {
    memory.work(now);
    if (!memory.answer_ready(now)) continue;
    memory.take_answer();
    return now - start;
  }
}

TEST(BankedMemory, unloaded_latency_is_that_of_a_closed_an_open_and_a_conflicting_row) {
  const MemoryConfig config = banked(false);
  BankedMemory memory(config);
  const auto row_stride = static_cast<std::uint64_t>(config.row_bytes) * static_cast<std::uint64_t>(config.banks);
  const auto base = static_cast<Cycle>(config.front_latency + config.t_cl + config.burst);
  EXPECT_EQ(latency_of(memory, 1000, 0), base + static_cast<Cycle>(config.t_rcd));
  EXPECT_EQ(latency_of(memory, 2000, 64), base);
  // Row 1 of the same bank: rows are spread over banks by XOR, so it lies one block further.
  EXPECT_EQ(latency_of(memory, 3000, row_stride + static_cast<std::uint64_t>(config.row_bytes)),
            base + static_cast<Cycle>(config.t_rcd + config.t_rp));
}

TEST(BankedMemory, streaming_keeps_the_bus_busy) {
  const MemoryConfig config = banked(false);
  BankedMemory memory(config);
  constexpr std::uint64_t kLines = 20000;
  std::uint64_t sent = 0, received = 0;
  Cycle now = 0;
  for (; received < kLines; ++now) {
    if (sent < kLines && memory.can_accept(sent * 64)) memory.accept(now, read_of(64 * sent++));
    memory.work(now);
    if (memory.answer_ready(now)) {
      memory.take_answer();
      ++received;
    }
  }
  const auto peak = kLines * static_cast<std::uint64_t>(config.burst);
  EXPECT_GE(now, peak);
  EXPECT_LE(static_cast<double>(now), 1.01 * static_cast<double>(peak));
  EXPECT_GT(static_cast<double>(memory.counters().row_hits), 0.96 * kLines);
}

TEST(BankedMemory, latency_grows_with_load_and_with_refresh_and_half_the_peak_is_reached_at_random) {
  double last_latency = 0;
  for (const bool refresh : {false, true}) {
    double latency_at_half = 0;
    last_latency = 0;
    for (const Cycle interval : {100, 25, 13, 9}) {
      BankedMemory memory(banked(refresh));
      std::map<std::uint16_t, Cycle> sent_at;
      std::uint64_t sum = 0, answers = 0, waiting = 0;
      std::uint16_t id = 0;
      std::uint64_t random = 1;
      for (Cycle now = 0; answers < 5000; ++now) {
        if (now % interval == 0) ++waiting;
        random = mix64(random);
        const std::uint64_t address = (random % (1u << 20)) * 64;
        if (waiting > 0 && sent_at.size() < 300 && memory.can_accept(address)) {
          memory.accept(now, read_of(address, id));
          sent_at[id++] = now;
          --waiting;
        }
        memory.work(now);
        if (!memory.answer_ready(now)) continue;
        sum += now - sent_at.at(memory.answer().id);
        sent_at.erase(memory.answer().id);
        memory.take_answer();
        ++answers;
      }
      EXPECT_LT(waiting, 20u) << "interval " << interval << ": the offered load is not served";
      const double latency = static_cast<double>(sum) / static_cast<double>(answers);
      EXPECT_GT(latency, last_latency);
      last_latency = latency;
      if (interval == 9) latency_at_half = latency;
    }
    EXPECT_GT(latency_at_half, 79);  // front + tRP + tRCD + tCL + burst
    EXPECT_LT(latency_at_half, 300);
  }
}

/// A key whose row of the paper's table is `begin_x` (with R_ray = 4) plus 4^3 * end_x.
std::uint32_t key_of(unsigned begin_x, unsigned end_x = 0) { return begin_x | (end_x << 15); }

LaneKeys keys_of(std::initializer_list<std::uint32_t> list) {
  LaneKeys keys;
  for (const auto key : list) keys.key[keys.count++] = key;
  return keys;
}

/// Cycles that the reads take in a unit with these banks and ports.
int table_cycles(const cull::MaskTester& tester, int banks, int ports, const LaneKeys& keys) {
  UnitConfig config;
  config.mask_test.design = tester.design();
  config.mask_test.banks = banks;
  config.mask_test.ports = ports;
  const cull::OnChipTables tables(tester, config.mask_test.rows, config.mask_test.projection_tables);
  return TableBanks(config, tables).read(keys, Context{});
}

TEST(TableBanks, take_the_most_loaded_bank_over_its_ports) {
  const cull::MaskTester tester(Design::MaskLut, {});
  const LaneKeys apart = keys_of({key_of(0), key_of(1), key_of(2), key_of(3)});  // rows 0, 1, 2, 3
  EXPECT_EQ(table_cycles(tester, 4, 1, apart), 1);
  EXPECT_EQ(table_cycles(tester, 2, 1, apart), 2);
  EXPECT_EQ(table_cycles(tester, 1, 1, apart), 4);
  EXPECT_EQ(table_cycles(tester, 1, 2, apart), 2);
  EXPECT_EQ(table_cycles(tester, 1, 3, apart), 2);
  EXPECT_EQ(table_cycles(tester, 1, 4, apart), 1);
  const LaneKeys one_bank = keys_of({key_of(0, 0), key_of(0, 1), key_of(0, 2)});  // rows 0, 64, 128
  EXPECT_EQ(table_cycles(tester, 4, 1, one_bank), 3);
  const LaneKeys same_row = keys_of({key_of(2), key_of(2), key_of(2), key_of(2)});
  EXPECT_EQ(table_cycles(tester, 1, 1, same_row), 1);
  const LaneKeys uncertain = keys_of({key_of(0) | cull::CellKey::kUncertain, key_of(0, 1) | cull::CellKey::kUncertain});
  EXPECT_EQ(table_cycles(tester, 1, 1, uncertain), 1);
  EXPECT_EQ(table_cycles(tester, 1, 1, LaneKeys{}), 1);
}

TEST(TableBanks, read_a_single_projection_table_three_times_a_lane) {
  const cull::MaskTester tester(Design::Projection, {});
  UnitConfig config;
  config.mask_test.design = Design::Projection;
  config.mask_test.banks = 1;
  // begin (1, 2, 3), end (0, 0, 0): three different rows of the one table.
  const LaneKeys keys = keys_of({0b00011'00010'00001});
  const cull::OnChipTables single(tester, cull::TableRows::All, 1), three(tester, cull::TableRows::All, 3);
  TableBanks one_memory(config, single), three_memories(config, three);
  EXPECT_EQ(one_memory.read(keys, Context{}), 3);
  ASSERT_EQ(one_memory.tables().size(), 1u);
  EXPECT_EQ(one_memory.tables()[0].bits(), 256u * 16);
  EXPECT_EQ(one_memory.usage(0).rows_used, 3u);
  EXPECT_EQ(three_memories.read(keys, Context{}), 1);
  ASSERT_EQ(three_memories.tables().size(), 3u);
  for (std::size_t memory = 0; memory < 3; ++memory) EXPECT_EQ(three_memories.usage(memory).rows_used, 1u);
}

/// Keys of R_ray = 4 whose masks are all different, or all the same.
LaneKeys keys_with_masks(const cull::DedupTable& table, int count, bool different) {
  std::map<std::uint32_t, LaneKeys> of_mask;
  LaneKeys chosen;
  for (std::uint32_t number = 0; number < cull::key_count(4) && chosen.count < count; ++number) {
    LaneKeys& keys = of_mask[table.id(number)];
    if (keys.count == count) continue;
    keys.key[keys.count++] = cull::numbered_key(number, 4).packed;
    if (different && keys.count == 1) chosen.key[chosen.count++] = keys.key[0];
    if (!different && keys.count == count) chosen = keys;
  }
  return chosen;
}

TEST(TableBanks, read_the_second_memory_of_dedup_after_the_first) {
  const cull::MaskTester tester(Design::Dedup, {});
  const auto lanes_of = [&](bool different) { return keys_with_masks(*tester.dedup_table(), 3, different); };
  // Three keys take three turns at one bank of ids; three different masks then three more, less the one in which the
  // last id comes; one mask in common is read once.
  ASSERT_EQ(lanes_of(true).count, 3);
  ASSERT_EQ(lanes_of(false).count, 3);
  EXPECT_EQ(table_cycles(tester, 1, 1, lanes_of(true)), 5);
  EXPECT_EQ(table_cycles(tester, 1, 1, lanes_of(false)), 3);
  EXPECT_EQ(table_cycles(tester, 1, 2, lanes_of(true)), 3);
  EXPECT_EQ(table_cycles(tester, 1, 4, lanes_of(true)), 1);
}

TEST(TableBanks, read_the_compression_lut_beside_the_ray_masks) {
  const auto lut = std::make_shared<const cull::CompressionLut>(4, std::vector<std::uint64_t>{1, 3, 7, 15});
  const cull::MaskTester tester(Design::MaskLut, {.entries = cull::kMinEntries}, lut);
  LaneKeys lanes = keys_of({key_of(0), key_of(1), key_of(2), key_of(3)});
  for (std::uint32_t i = 0; i < 4; ++i) lanes.mask_index[i] = i;
  EXPECT_EQ(table_cycles(tester, 4, 1, lanes), 1);
  for (std::uint32_t i = 0; i < 3; ++i) lanes.mask_index[i] = 4 * (i % 2);  // 0, 4, 0: one bank, two rows
  lanes.count = 3;
  EXPECT_EQ(table_cycles(tester, 4, 1, lanes), 2);
  // Comparators have no key to read by, but their object masks are in the LUT all the same.
  const cull::MaskTester comparators(Design::Comparators, {.entries = cull::kMinEntries}, lut);
  EXPECT_EQ(table_cycles(comparators, 4, 1, lanes), 2);
  EXPECT_EQ(table_cycles(cull::MaskTester(Design::Comparators, {}), 1, 1, lanes), 1);
}

TEST(Parameters, defaults_are_those_of_the_configuration_and_in_range) {
  const UnitConfig config;
  std::set<std::string> keys;
  for (const Parameter& parameter : parameters()) {
    SCOPED_TRACE(parameter.key);
    EXPECT_TRUE(keys.insert(parameter.key).second) << "twice";
    EXPECT_EQ(parameter.get(config), parameter.default_value);
    EXPECT_FALSE(parameter.description.empty());
    if (const auto* number = std::get_if<std::int64_t>(&parameter.default_value)) {
      EXPECT_GE(*number, parameter.minimum);
      EXPECT_LE(*number, parameter.maximum);
    }
  }
  EXPECT_NO_THROW(check_consistency(config));
}

TEST(Parameters, setting_one_changes_it_and_no_other) {
  for (const Parameter& changed : parameters()) {
    UnitConfig config;
    ParameterValue value = changed.default_value;
    if (auto* number = std::get_if<std::int64_t>(&value))
      *number = *number == changed.minimum ? changed.maximum : changed.minimum;
    if (auto* name = std::get_if<std::string>(&value)) *name = changed.choices[*name == changed.choices[0] ? 1 : 0];
    changed.set(config, value);
    for (const Parameter& parameter : parameters()) {
      SCOPED_TRACE(changed.key + " set, looked at " + parameter.key);
      EXPECT_EQ(parameter.get(config), parameter.key == changed.key ? value : parameter.default_value);
    }
  }
}

TEST(Parameters, combinations_that_cannot_be_are_refused_by_the_names_of_their_keys) {
  const auto refused = [](auto change) {
    UnitConfig config;
    change(config);
    try {
      check_consistency(config);
    } catch (const Error& error) {
      return error.where();
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refused([](UnitConfig& c) { c.node_cache.bytes = 96 * 1024; }),
            "node_cache.bytes, node_cache.ways, memory.line_bytes");
  EXPECT_EQ(refused([](UnitConfig& c) { c.table_cache.bytes = 4096 + 128; }),
            "table_cache.bytes, table_cache.ways, memory.line_bytes");
  EXPECT_EQ(refused([](UnitConfig& c) { c.stack.entries = 4; }), "stack.spill_batch, stack.entries");
  EXPECT_EQ(refused([](UnitConfig& c) { c.memory.line_bytes = 32; }), "stack.spill_batch, memory.line_bytes");
  EXPECT_EQ(refused([](UnitConfig& c) { c.mask_test.banks = 3; }), "mask_test.banks");
  EXPECT_EQ(refused([](UnitConfig& c) { c.unit.contexts = 257; }), "unit.contexts");
  EXPECT_EQ(refused([](UnitConfig& c) { c.mask_test.projection_tables = 2; }), "mask_test.projection_tables");
  EXPECT_EQ(refused([](UnitConfig& c) { c.memory.t_refi = 200; }), "memory.t_rfc, memory.t_refi");
  EXPECT_EQ(refused([](UnitConfig& c) { c.watchdog.cycles = 300; }), "watchdog.cycles");
}

}  // namespace
}  // namespace ctu::pipeline
