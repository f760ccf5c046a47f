// rtl/line_fetch.sv as table_fetch's control: the lines come from the model's tables, and dedup's in two rounds;
// against the model's table_fetch within a unit at work.
#include <algorithm>

#include "VLineFetchTwoRounds.h"
#include "VMutantFetchSecondRoundLast.h"
#include "model/pipeline/table_lines.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using pipeline::Activity;
using pipeline::LineNumber;
using pipeline::MemoryModel;
using pipeline::NodeToken;
using pipeline::UnitConfig;

constexpr int kPorts = 2;        // as in line_fetch.cmake
constexpr int kLineBytes = 32;   // likewise
constexpr int kNumberBits = 27;  // of lines, in 32 bits of address

struct Compared {
  std::string difference;
  std::uint64_t second_rounds = 0, without_lines = 0;
  std::uint64_t cycles_of[pipeline::kActivities] = {};
};

template <class Model>
class Twin {
 public:
  Twin(const UnitConfig& config, pipeline::TappedUnit& unit)
      : unit_(unit),
        layout_(config, unit.state().tables, pipeline::MemoryMap(config, unit.state().image),
                unit.state().image.compressed()),
        design_(config.mask_test.design) {
    const int lines = config.table_cache.bytes / kLineBytes;
    twin_.ways_i = static_cast<std::uint8_t>(config.table_cache.ways);
    twin_.set_mask_i = static_cast<std::uint8_t>(lines / config.table_cache.ways - 1);
    twin_.mshrs_i = static_cast<std::uint8_t>(config.table_cache.mshrs);
    twin_.hit_latency_i = static_cast<std::uint8_t>(config.table_cache.hit_latency);
    twin_.two_rounds_i = pipeline::reads_twice(design_);
    reset(twin_);
  }

  template <class Stage>
  std::string cycle(const Stage& model, Compared& compared) {
    twin_.requests_valid_i = model.requests.valid;
    twin_.requests_slot_i = static_cast<std::uint8_t>(model.requests.token.slot);
    twin_.fills_valid_i = model.fills.valid;
    twin_.fills_id_i = static_cast<std::uint8_t>(model.fills.token.id);
    twin_.misses_ready_i = model.misses.ready;
    twin_.done_ready_i = model.done.ready;
    twin_.none_i = 0;
    twin_.eval();
    if (twin_.requests_pop_o) token_of_[twin_.slot_o] = model.requests.token;
    if (twin_.starts_o) start(compared);
    drive_lines();
    twin_.eval();
    compare(model, compared);
    next_ += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(twin_.looked_up_o)));
    clock(twin_);
    return difference_.take();
  }

 private:
  /// The distinct lines of the round, in the order of the lanes.
  void start(Compared& compared) {
    lines_.clear();
    next_ = 0;
    const NodeToken& token = token_of_[twin_.slot_o];
    auto& state = unit_.state();
    pipeline::for_each_read(state.tables, state.source.keys(token), state.contexts[token.slot],
                            [&](const cull::TableRead& read, std::uint32_t mask_index) {
                              if (pipeline::is_second_read(design_, read.table) != static_cast<bool>(twin_.second_o))
                                return;
                              const pipeline::ByteSpan span = layout_.bytes(read, mask_index);
                              for (LineNumber line = span.first / kLineBytes; line <= span.last / kLineBytes; ++line)
                                if (std::find(lines_.begin(), lines_.end(), line) == lines_.end())
                                  lines_.push_back(line);
                            });
    compared.second_rounds += twin_.second_o;
    compared.without_lines += lines_.empty();
    twin_.none_i = lines_.empty();
  }

  void drive_lines() {
    twin_.lines_i = 0;
    twin_.last_i = 0;
    for (std::size_t p = 0; p < kPorts && next_ + p < lines_.size(); ++p) {
      twin_.lines_i |= lines_[next_ + p] << (kNumberBits * p);
      if (next_ + p + 1 == lines_.size()) twin_.last_i = static_cast<std::uint8_t>(twin_.last_i | 1u << p);
    }
  }

  template <class Stage>
  void compare(const Stage& model, Compared& compared) {
    difference_.same("requests pop", twin_.requests_pop_o, model.requests.popped)
        .same("fills pop", twin_.fills_pop_o, model.fills.popped)
        .same("misses push", twin_.misses_push_o, model.misses.pushed)
        .same("done push", twin_.done_push_o, model.done.pushed)
        .same("activity", twin_.activity_o, static_cast<unsigned>(model.account.current()));
    const auto& miss = model.misses.token;
    if (model.misses.pushed)
      difference_.same("miss", twin_.misses_data_o, miss.address << 9 | static_cast<std::uint64_t>(miss.id) << 1);
    if (model.done.pushed) difference_.same("done", twin_.done_slot_o, model.done.token.slot);
    ++compared.cycles_of[static_cast<int>(model.account.current())];
  }

  VerilatedContext context_;
  Model twin_{from_noise(context_)};
  pipeline::TappedUnit& unit_;
  pipeline::TableLayout layout_;
  cull::Design design_;
  std::vector<LineNumber> lines_;
  std::size_t next_ = 0;
  NodeToken token_of_[pipeline::kMaxContexts] = {};
  Difference difference_;
};

template <class Model>
Compared compare(const test::World& world, const UnitConfig& config, std::uint64_t stall_seed) {
  Compared compared;
  StageRun run(world, config, stall_seed);
  Twin<Model> twin(config, run.unit());
  compared.difference = run.first_difference([&] { return twin.cycle(*run.unit().stages().table_fetch, compared); });
  return compared;
}

UnitConfig config_of(const test::World& world, MemoryModel model, int lines, int hit_latency) {
  UnitConfig config = world.config();
  config.unit.contexts = 16;
  config.memory.model = model;
  config.memory.latency = 30;
  config.memory.interval = 1;
  config.memory.line_bytes = kLineBytes;
  config.stack.spill_batch = 4;
  config.table_cache = {lines * kLineBytes, lines < 4 ? 1 : 4, hit_latency, kPorts, 4};
  return config;
}

Compared expect_twins(cull::Design design) {
  SCOPED_TRACE(oracle::seed_note());
  const test::World world("gen:straight-hair?strands=150", design, 40);
  Compared all;
  for (const MemoryModel model : {MemoryModel::Ideal, MemoryModel::Banked}) {
    for (const int lines : {1, 32}) {
      for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed()}) {
        const Compared compared =
            compare<VLineFetchTwoRounds>(world, config_of(world, model, lines, lines == 1 ? 1 : 5), stall_seed);
        EXPECT_EQ(compared.difference, "") << lines << " lines, stall seed " << stall_seed;
        all.second_rounds += compared.second_rounds;
        all.without_lines += compared.without_lines;
        for (int i = 0; i < pipeline::kActivities; ++i) all.cycles_of[i] += compared.cycles_of[i];
      }
    }
  }
  EXPECT_GT(all.without_lines, 20u);
  for (const Activity activity : {Activity::Busy, Activity::Idle, Activity::FillPort, Activity::Memory})
    EXPECT_GT(all.cycles_of[static_cast<int>(activity)], 50u) << name_of(activity);
  return all;
}

TEST(TableLookup, does_what_the_model_does_in_every_cycle_in_two_rounds) {
  EXPECT_GT(expect_twins(cull::Design::Dedup).second_rounds, 100u);
}
TEST(TableLookup, does_what_the_model_does_in_every_cycle_in_one_round) {
  EXPECT_EQ(expect_twins(cull::Design::Projection).second_rounds, 0u);
}
TEST(TableLookupMutants, a_second_round_behind_new_tokens_is_caught) {
  const test::World world("gen:straight-hair?strands=150", cull::Design::Dedup, 40);
  const Compared compared =
      compare<VMutantFetchSecondRoundLast>(world, config_of(world, MemoryModel::Banked, 32, 5), oracle::test_seed());
  EXPECT_NE(compared.difference, "");
}

}  // namespace
}  // namespace ctu::rtl
