// child_sort: the surviving lanes by (t0, lane), nearest first: a network of compare-and-swap cells.
//
//   in   survivors  the lanes that pass
//   out  sorted     the same with their order
//   latency child_sort.latency (five comparators in three rows), one node a cycle
//   stalls: output_full
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/child_sort.sv.
#pragma once

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipelined.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class ChildSort {
 public:
  static constexpr const char* kName = "child_sort";
  static constexpr Place kPlace = Place::ChildSort;
  typename Wiring::template In<NodeToken> survivors;
  typename Wiring::template Out<NodeToken> sorted;

  ChildSort(const UnitConfig& config, Contexts& contexts, Source& source)
      : contexts_(contexts), source_(source), pipe_(config.child_sort.latency) {}

  bool step(Cycle now) {
    return step_pipelined(now, survivors, sorted, pipe_, account, [&](const NodeToken& token) {
      contexts_.move(token.slot, now, kPlace);
      return take(token);
    });
  }
  Entering<NodeToken> take(const NodeToken& token) {
    return {{token.slot, token.hits, token.survivors, source_.child_order(token.slot, token.survivors), 0}};
  }
  Cycle latency() const { return pipe_.latency(); }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }

  Account account{kName, {Activity::OutputFull}};

 private:
  Contexts& contexts_;
  Source& source_;
  Pipe<NodeToken> pipe_;
};

}  // namespace ctu::pipeline
