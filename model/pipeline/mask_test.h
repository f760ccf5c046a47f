// mask_test: does the ray touch an occupied cell? Reads the ray mask of each located lane from the tables on chip (or
// takes the cells the comparators found) and ANDs it with the lane's object mask. Left out for design none.
//
//   in   located    the lanes hit, with their keys in the context
//   out  survivors  the lanes that pass
//   latency mask_test.latency; a node whose reads do not fit the banks' ports keeps the entrance for more cycles
//   (table_banks.h), which are stalls by bank_conflict. Uncertain lanes pass without a read.
//   stalls: output_full, bank_conflict
#pragma once

#include <bit>

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipelined.h"
#include "model/pipeline/table_banks.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class MaskTest {
 public:
  static constexpr const char* kName = "mask_test";
  typename Wiring::template In<NodeToken> located;
  typename Wiring::template Out<NodeToken> survivors;

  MaskTest(const UnitConfig& config, const cull::MaskTester& tester, Contexts& contexts, Source& source)
      : contexts_(contexts), source_(source), tables_(config, tester), pipe_(config.mask_test.latency) {}

  bool step(Cycle now) {
    bool entered = false;
    const bool moved = step_pipelined(now, located, survivors, pipe_, account, [&](const NodeToken& token) {
      entered = true;
      contexts_.move(token.slot, now, Place::MaskTest);
      const int cycles = tables_.read(source_.keys(token.slot, token.hits));
      const MaskAnswer answer = source_.mask_test(token.slot, token.hits);
      pipe_.enter(now, {token.slot, token.hits, answer.survivors, 0}, static_cast<Cycle>(cycles));
      culled_ += static_cast<unsigned>(std::popcount(static_cast<unsigned>(token.hits & ~answer.survivors)));
      uncertain_ += static_cast<unsigned>(std::popcount(answer.uncertain));
    });
    const bool conflict = !entered && !pipe_.can_enter(now);
    if (conflict && account.current() == Activity::Busy) account.set(now, Activity::BankConflict);
    return moved;
  }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }
  std::uint64_t culled() const { return culled_; }
  std::uint64_t uncertain() const { return uncertain_; }
  const TableBanks& tables() const { return tables_; }

  Account account{kName, {Activity::OutputFull, Activity::BankConflict}};

 private:
  Contexts& contexts_;
  Source& source_;
  TableBanks tables_;
  Pipe<NodeToken> pipe_;
  std::uint64_t culled_ = 0, uncertain_ = 0;
};

}  // namespace ctu::pipeline
