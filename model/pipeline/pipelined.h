// The step that every rigid pipeline of the unit takes: the last register leaves if it can, the first one fills.
#pragma once

#include "model/pipeline/accounting.h"
#include "model/pipeline/cycle.h"
#include "model/pipeline/pipe.h"

namespace ctu::pipeline {

/// What a token becomes when a stage takes it, and for how many cycles it keeps the entrance.
template <class T>
struct Entering {
  T token;
  Cycle occupies = 1;
};

/// `take(token)` gives the Entering<T>. Whether anything moved.
template <class In, class Out, class T, class Take>
bool step_pipelined(Cycle now, In& in, Out& out, Pipe<T>& pipe, Account& account, Take&& take) {
  bool moved = false;
  if (pipe.exit_ready(now)) {
    if (!out.can_push(now)) {
      pipe.freeze(now);
      account.set(Activity::OutputFull);
      return false;
    }
    out.push(now, pipe.leave(now));
    moved = true;
  }
  if (in.can_pop(now) && pipe.can_enter(now)) {
    const Entering<T> entering = take(in.front());
    pipe.enter(now, entering.token, entering.occupies);
    in.pop(now);
    moved = true;
  }
  account.set(moved || !pipe.empty() ? Activity::Busy : Activity::Idle);
  return moved;
}

}  // namespace ctu::pipeline
