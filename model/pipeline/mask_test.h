// mask_test: does the ray touch an occupied cell? Reads the ray mask of each lane asked from the design's tables (or
// takes the cells the comparators found) and ANDs it with the lane's object mask, which compressed masks fetch from the
// compression LUT by the lane's index; or reads the answer as one bit of a row. Left out for design none.
//
//   in   located    the lanes hit and asked, with their keys in the context
//   out  survivors  the lanes that pass: those not asked (full masks), the uncertain ones, those that share a cell
//   latency mask_test.latency, and mask_test.second_latency more where resident tables are read twice (dedup); a node
//   whose reads do not fit the banks' ports keeps the entrance for more cycles (table_banks.h), which are stalls by
//   bank_conflict. Lanes not asked and uncertain lanes make no read. Rows from table_fetch come with the node: one node
//   a cycle.
//   stalls: output_full, bank_conflict
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/mask_test.sv.
#pragma once

#include <bit>

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipelined.h"
#include "model/pipeline/table_banks.h"
#include "model/pipeline/table_reads.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class MaskTest {
 public:
  static constexpr const char* kName = "mask_test";
  static constexpr Place kPlace = Place::MaskTest;
  typename Wiring::template In<NodeToken> located;
  typename Wiring::template Out<NodeToken> survivors;

  MaskTest(const UnitConfig& config, const cull::OnChipTables& tables, Contexts& contexts, Source& source)
      : contexts_(contexts), source_(source), tables_(config, tables), pipe_(latency_of(config)) {}

  bool step(Cycle now) {
    bool entered = false;
    const bool moved = step_pipelined(now, located, survivors, pipe_, account, [&](const NodeToken& token) {
      entered = true;
      contexts_.move(token.slot, now, kPlace);
      return take(token);
    });
    const bool conflict = !entered && !pipe_.can_enter(now);
    if (conflict && account.current() == Activity::Busy) account.correct(Activity::BankConflict);
    return moved;
  }
  Entering<NodeToken> take(const NodeToken& token) {
    const int cycles = tables_.read(source_.keys(token), contexts_[token.slot]);
    const MaskAnswer answer = source_.mask_test(token);
    culled_ += static_cast<unsigned>(std::popcount(static_cast<unsigned>(token.hits & ~answer.survivors)));
    uncertain_ += static_cast<unsigned>(std::popcount(answer.uncertain));
    return {{token.slot, token.hits, answer.survivors, 0, 0}, static_cast<Cycle>(cycles)};
  }
  Cycle latency() const { return pipe_.latency(); }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }
  std::uint64_t culled() const { return culled_; }
  std::uint64_t uncertain() const { return uncertain_; }
  const TableBanks& tables() const { return tables_; }

  Account account{kName, {Activity::OutputFull, Activity::BankConflict}};

 private:
  static int latency_of(const UnitConfig& config) {
    const bool two_reads = reads_twice(config.mask_test.design) && config.table_cache.bytes == 0;
    return config.mask_test.latency + (two_reads ? config.mask_test.second_latency : 0);
  }

  Contexts& contexts_;
  Source& source_;
  TableBanks tables_;
  Pipe<NodeToken> pipe_;
  std::uint64_t culled_ = 0, uncertain_ = 0;
};

}  // namespace ctu::pipeline
