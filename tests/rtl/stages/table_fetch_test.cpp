// rtl/table_fetch.sv against model/pipeline/table_fetch.h: every handshake, token and account in every cycle, and the
// rows that each lane gets when its node leaves and still has when its context asks for the next.
#include <algorithm>

#include "VMutantFetchSecondRoundLast.h"
#include "VMutantRowOffsetIgnored.h"
#include "VMutantTableLinesRepeated.h"
#include "VTableFetchBitTable.h"
#include "VTableFetchComparators.h"
#include "VTableFetchDedup.h"
#include "VTableFetchDedupCompressed.h"
#include "VTableFetchMaskLut.h"
#include "VTableFetchOneProjection.h"
#include "VTableFetchProjection.h"
#include "sim/cosim/table_image.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/fetched_rows.h"
#include "tests/rtl/stages/ports.h"

namespace ctu::rtl {
namespace {

using cull::Design;
using cull::TableRows;
using pipeline::Activity;
using pipeline::MemoryModel;
using pipeline::NodeToken;
using pipeline::UnitConfig;

/// The parameters of a model in table_fetch.cmake, as the C++ side says them.
struct Variant {
  Design design;
  cull::MaskOptions options{};
  TableRows rows = TableRows::All;
  int ports = 1, line_bytes = 32, projection_tables = 3;
};

struct Compared {
  std::string difference;
  std::uint64_t nodes = 0, without_lines = 0, rows = 0;
  std::uint64_t cycles_of[pipeline::kActivities] = {};
};

template <class Model>
class Twin {
 public:
  Twin(const test::World& world, const UnitConfig& config, pipeline::TappedUnit& unit)
      : world_(world),
        unit_(unit),
        rows_(world, config),
        layout_(config, unit.state().tables, pipeline::MemoryMap(config, unit.state().image),
                unit.state().image.compressed()),
        memory_(layout_.end(), 0xA5),
        line_bytes_(static_cast<std::size_t>(config.memory.line_bytes)) {
    cosim::write_tables(memory_, layout_, rows_.content());
    const int lines = config.table_cache.bytes / config.memory.line_bytes;
    twin_.ways_i = static_cast<std::uint8_t>(config.table_cache.ways);
    twin_.set_mask_i = static_cast<std::uint8_t>(lines / config.table_cache.ways - 1);
    twin_.mshrs_i = static_cast<std::uint8_t>(config.table_cache.mshrs);
    twin_.hit_latency_i = static_cast<std::uint8_t>(config.table_cache.hit_latency);
    BitWriter bases(&twin_.table_base_i[0]);
    for (std::size_t table = 0; table < rows_.content().tables().size(); ++table) {
      bases.put(layout_.base(table), kAddressBits);
      if (layout_.is_read_by_bit(table)) twin_.bit_row_shift_i = static_cast<std::uint8_t>(layout_.stride_shift(table));
    }
    reset(twin_);
  }

  template <class Stage>
  std::string cycle(const Stage& model, Compared& compared) {
    drive(model);
    compare(model, compared);
    const NodeToken& next = model.requests.token;
    if (model.requests.popped) check_rows(kept_[next.slot], compared);
    clock(twin_);
    const NodeToken& done = model.done.token;
    if (model.done.pushed) {
      kept_[done.slot] = rows_of(done);
      check_rows(kept_[done.slot], compared);
    }
    return difference_.take();
  }

 private:
  static constexpr int kAddressBits = 32;
  using Words = std::vector<std::uint32_t>;

  /// The rows of a node that has left.
  struct Kept {
    pipeline::Slot slot = 0;
    unsigned lanes = 0;  ///< that read
    Words rows{};        ///< all lanes' fields, as row_o
    int bits = 0;        ///< of a lane
  };

  template <class Stage>
  void drive(const Stage& model) {
    twin_.requests_valid_i = model.requests.valid;
    const NodeToken& token = model.requests.token;
    twin_.requests_data_i = node_bits(token);
    twin_.fills_valid_i = model.fills.valid;
    if (model.fills.valid) {
      const std::uint16_t id = model.fills.token.id;
      BitWriter fill(&twin_.fills_data_i[0]);
      for (std::size_t i = 0; i < line_bytes_; ++i) fill.put(memory_[address_of_[id] + i], 8);
      fill.put(id, 8);
    }
    twin_.misses_ready_i = model.misses.ready;
    twin_.done_ready_i = model.done.ready;
    twin_.eval();
    // The register files answer in the same cycle.
    set_port(twin_.key_i, key_words(twin_.key_slot_o));
    set_port(twin_.index_i, index_words(twin_.key_slot_o));
    twin_.eval();
  }

  template <class Stage>
  void compare(const Stage& model, Compared& compared) {
    difference_.same("requests pop", twin_.requests_pop_o, model.requests.popped)
        .same("fills pop", twin_.fills_pop_o, model.fills.popped)
        .same("misses push", twin_.misses_push_o, model.misses.pushed)
        .same("done push", twin_.done_push_o, model.done.pushed)
        .same("activity", twin_.activity_o, static_cast<unsigned>(model.account.current()));
    const auto& miss = model.misses.token;
    if (model.misses.pushed) {
      difference_.same("miss", twin_.misses_data_o, miss.address << 9 | static_cast<std::uint64_t>(miss.id) << 1);
      address_of_[miss.id] = miss.address;
    }
    if (model.done.pushed) difference_.same("done", twin_.done_data_o, node_bits(model.done.token));
    compared.nodes += model.done.pushed;
    ++compared.cycles_of[static_cast<int>(model.account.current())];
  }

  static std::uint32_t node_bits(const NodeToken& token) {
    return static_cast<std::uint32_t>(token.slot) << 20 | static_cast<std::uint32_t>(token.hits) << 16 |
           static_cast<std::uint32_t>(token.survivors) << 12 | static_cast<std::uint32_t>(token.order) << 4 |
           token.asked;
  }

  const pipeline::ExecSource::Registers& registers(unsigned slot) const {
    return unit_.state().source.registers(static_cast<pipeline::Slot>(slot));
  }

  Words key_words(unsigned slot) const {
    Words words(4);
    BitWriter writer(words.data());
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const std::uint32_t key = registers(slot).key[lane];
      writer.put(key, 30).put(key >> 31, 1);
    }
    return words;
  }

  Words index_words(unsigned slot) const {
    Words words(2);
    if (world_.tester().compression_lut() == nullptr) return words;
    BitWriter writer(words.data());
    const int bits = std::bit_width(static_cast<unsigned>(world_.tester().options().entries - 1));
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      writer.put(object_mask(world_.image(), registers(slot), lane)[0], bits);
    return words;
  }

  Kept rows_of(const NodeToken& token) const {
    Kept kept{token.slot, 0, Words(words_of<std::remove_reference_t<decltype(twin_.row_o)>>() + 1), 0};
    BitWriter writer(kept.rows.data());
    const auto& r = registers(token.slot);
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      rows_.put_lane(writer, r, lane);
      if ((token.asked >> lane & 1) != 0 && rows_.reads(r, lane)) kept.lanes |= 1u << lane;
    }
    kept.bits = static_cast<int>(writer.size()) / intersect::kLanes;
    return kept;
  }

  void check_rows(const Kept& kept, Compared& compared) {
    if (kept.bits == 0) return;  // the context has had no node yet
    twin_.row_slot_i = static_cast<std::uint8_t>(kept.slot);
    twin_.eval();
    const Words words = get_port(twin_.row_o);
    BitReader twin(words.data()), model(kept.rows.data());
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      for (int bit = 0; bit < kept.bits; bit += 32) {
        const int count = std::min(32, kept.bits - bit);
        const std::uint64_t is = twin.take(count), expected = model.take(count);
        if ((kept.lanes >> lane & 1) == 0) continue;
        difference_.same("row", is, expected);
        ++compared.rows;
      }
    if (kept.lanes == 0) ++compared.without_lines;
  }

  VerilatedContext context_;
  Model twin_{from_noise(context_)};
  const test::World& world_;
  pipeline::TappedUnit& unit_;
  FetchedRows rows_;
  pipeline::TableLayout layout_;
  std::vector<std::uint8_t> memory_;
  std::size_t line_bytes_;
  std::uint64_t address_of_[pipeline::kMaxMissRegisters] = {};
  Kept kept_[pipeline::kMaxContexts] = {};
  Difference difference_;
};

template <class Model>
Compared compare(const test::World& world, const UnitConfig& config, std::uint64_t stall_seed) {
  Compared compared;
  StageRun run(world, config, stall_seed);
  Twin<Model> twin(world, config, run.unit());
  compared.difference = run.first_difference([&] { return twin.cycle(*run.unit().stages().table_fetch, compared); });
  return compared;
}

UnitConfig config_of(const test::World& world, const Variant& variant, MemoryModel model, int lines, int hit_latency) {
  UnitConfig config = world.config();
  config.unit.contexts = 16;
  config.memory.model = model;
  config.memory.latency = 30;
  config.memory.interval = 1;
  config.memory.line_bytes = variant.line_bytes;
  config.stack.spill_batch = 4;
  config.cell_locate.units = config.comparators.units = 4;
  config.mask_test.rows = variant.rows;
  config.mask_test.projection_tables = variant.projection_tables;
  config.table_cache = {lines * variant.line_bytes, lines < 4 ? 1 : 4, hit_latency, variant.ports, 4};
  return config;
}

/// Straight hair, seen from where every kind of rows serves.
test::World make_world(const Variant& variant) {
  constexpr const char* kScene = "gen:straight-hair?strands=150";
  const test::World any_rays(kScene, variant.design, 60, variant.options);
  return {any_rays.tree(), variant.design, rays_from_outside(any_rays), variant.options};
}

template <class Model>
void expect_twins(const Variant& variant) {
  SCOPED_TRACE(oracle::seed_note());
  const test::World world = make_world(variant);
  Compared all;
  for (const MemoryModel model : {MemoryModel::Ideal, MemoryModel::Banked}) {
    for (const int lines : {1, 32}) {
      for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed()}) {
        const Compared compared =
            compare<Model>(world, config_of(world, variant, model, lines, lines == 1 ? 1 : 5), stall_seed);
        EXPECT_EQ(compared.difference, "") << lines << " lines, stall seed " << stall_seed;
        all.nodes += compared.nodes;
        all.rows += compared.rows;
        all.without_lines += compared.without_lines;
        for (int i = 0; i < pipeline::kActivities; ++i) all.cycles_of[i] += compared.cycles_of[i];
      }
    }
  }
  EXPECT_GT(all.nodes, 500u);
  EXPECT_GT(all.rows, 500u);
  EXPECT_GT(all.without_lines, 20u);
  for (const Activity activity : {Activity::Busy, Activity::Idle, Activity::FillPort, Activity::Memory})
    EXPECT_GT(all.cycles_of[static_cast<int>(activity)], 50u) << name_of(activity);
}

TEST(RtlTableFetch, three_projections_and_an_entry_of_the_compression_lut) {
  expect_twins<VTableFetchProjection>({.design = Design::Projection, .options = {.entries = 64}});
}
TEST(RtlTableFetch, three_rows_of_one_projection_table) {
  expect_twins<VTableFetchOneProjection>({.design = Design::Projection,
                                          .options = {.resolution = 6, .ray_resolution = 6},
                                          .rows = TableRows::Folded,
                                          .ports = 3,
                                          .line_bytes = 64,
                                          .projection_tables = 1});
}
TEST(RtlTableFetch, ray_masks) { expect_twins<VTableFetchMaskLut>({.design = Design::MaskLut, .ports = 2}); }
TEST(RtlTableFetch, numbered_masks_in_two_rounds) {
  expect_twins<VTableFetchDedup>(
      {.design = Design::Dedup, .options = {.ray_resolution = 5}, .rows = TableRows::Folded, .ports = 2});
}
TEST(RtlTableFetch, numbered_bit_rows_in_two_rounds) {
  expect_twins<VTableFetchDedupCompressed>({.design = Design::Dedup, .options = {.entries = 300}, .ports = 4});
}
TEST(RtlTableFetch, bytes_of_bit_rows_of_reachable_keys) {
  expect_twins<VTableFetchBitTable>(
      {.design = Design::BitTable, .options = {.ray_resolution = 5, .entries = 64}, .rows = TableRows::Reachable});
}
TEST(RtlTableFetch, entries_of_the_compression_lut_wider_than_a_line_for_comparators) {
  expect_twins<VTableFetchComparators>(
      {.design = Design::Comparators, .options = {.resolution = 7, .ray_resolution = 7, .entries = 32}, .ports = 2});
}

/// A broken twin must differ from the model.
template <class Model>
void expect_caught() {
  const Variant dedup{.design = Design::Dedup, .options = {.ray_resolution = 5}, .rows = TableRows::Folded, .ports = 2};
  const test::World world = make_world(dedup);
  const Compared compared =
      compare<Model>(world, config_of(world, dedup, MemoryModel::Banked, 32, 5), oracle::test_seed());
  EXPECT_NE(compared.difference, "");
  testing::Test::RecordProperty("caught", compared.difference);
}
TEST(RtlTableFetchMutants, a_second_round_behind_new_nodes_is_caught) { expect_caught<VMutantFetchSecondRoundLast>(); }
TEST(RtlTableFetchMutants, a_line_looked_up_for_each_read_is_caught) { expect_caught<VMutantTableLinesRepeated>(); }
TEST(RtlTableFetchMutants, rows_taken_from_the_start_of_the_line_are_caught) {
  expect_caught<VMutantRowOffsetIgnored>();
}

}  // namespace
}  // namespace ctu::rtl
