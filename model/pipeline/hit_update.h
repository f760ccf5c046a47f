// hit_update: writes the best hit of a context, nearer first, equal t to the lower primitive. After the last triangle
// of a leaf the ray goes on to the stack, or is finished if any hit is enough and it has one.
//
//   in   tested  outcomes of triangle_test, or sphere_test
//   in   missed  from primitive_cull, contexts whose leaf had nothing to test; they go first
//   out  done    contexts whose leaf is finished
//   latency hit_update.latency from the leaf's last outcome, one outcome a cycle
//   stalls: output_full
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/hit_update.sv.
#pragma once

#include "model/pipeline/context.h"
#include "model/pipeline/event_log.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipe.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class HitUpdate {
 public:
  static constexpr const char* kName = "hit_update";
  typename Wiring::template In<typename Source::Test> tested;
  typename Wiring::template In<SlotToken> missed;
  typename Wiring::template Out<LeafDone> done;

  /// `has_missed`: there is a primitive_cull.
  HitUpdate(const UnitConfig& config, Contexts& contexts, Source& source, EventLog& log, bool has_missed)
      : contexts_(contexts), source_(source), log_(log), has_missed_(has_missed), pipe_(config.hit_update.latency) {}

  bool step(Cycle now) {
    bool moved = false;
    if (pipe_.exit_ready(now)) {
      if (!done.can_push(now)) {
        pipe_.freeze(now);
        account.set(Activity::OutputFull);
        return false;
      }
      done.push(now, pipe_.leave(now));
      moved = true;
    }
    if (has_missed_ && missed.can_pop(now)) {
      const Slot slot = missed.front().slot;
      missed.pop(now);
      finish_leaf(now, slot);
      moved = true;
    } else if (tested.can_pop(now)) {
      const typename Source::Test test = tested.front();
      tested.pop(now);
      source_.update(test);
      if (test.last) finish_leaf(now, test.slot);
      moved = true;
    }
    account.set(moved || !pipe_.empty() ? Activity::Busy : Activity::Idle);
    return moved;
  }
  Cycle next_event(Cycle now) const { return pipe_.next_event(now); }

  Account account{kName, {Activity::OutputFull}};

 private:
  void finish_leaf(Cycle now, Slot slot) {
    contexts_.move(slot, now, Place::HitUpdate);
    Context& context = contexts_[slot];
    log_.add({now, context.ray, context.visits, false, source_.finish_visit(slot)});
    ++context.visits;
    pipe_.enter(now, {slot, context.any_hit && source_.has_hit(slot)});
  }

  Contexts& contexts_;
  Source& source_;
  EventLog& log_;
  bool has_missed_;
  Pipe<LeafDone> pipe_;
};

}  // namespace ctu::pipeline
