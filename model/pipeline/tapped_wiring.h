// Links whose every handshake can be watched: what a co-simulation compares a twin with.
#pragma once

#include "model/pipeline/backpressure.h"
#include "model/pipeline/cycle.h"
#include "model/pipeline/link.h"

namespace ctu::pipeline {

/// Each port keeps what it saw at the start of the cycle and what the stage did in it. `sample` begins a cycle; links
/// refuse as Backpressure says.
struct TappedWiring {
  template <class T>
  struct In {
    Link<T> link;
    const Backpressure* backpressure = nullptr;
    int number = 0;
    bool valid = false;   ///< something can be popped in this cycle
    bool popped = false;  ///< the stage has popped it
    T token{};            ///< what it is

    void sample(Cycle now) {
      valid = link.can_pop(now) && !backpressure->refuses(number, Side::Pop, now);
      popped = false;
      if (valid) token = link.front();
    }
    bool can_pop(Cycle) const { return valid && !popped; }
    const T& front() const { return token; }
    void pop(Cycle now) {
      popped = true;
      link.pop(now);
    }
  };
  template <class T>
  struct Out {
    Link<T>* link = nullptr;
    const Backpressure* backpressure = nullptr;
    int number = 0;
    bool ready = false;   ///< something can be pushed in this cycle
    bool pushed = false;  ///< the stage has pushed `token`
    T token{};

    void sample(Cycle now) {
      ready = link != nullptr && link->can_push(now) && !backpressure->refuses(number, Side::Push, now);
      pushed = false;
    }
    bool can_push(Cycle) const { return ready && !pushed; }
    void push(Cycle now, const T& value) {
      pushed = true;
      token = value;
      link->push(now, value);
    }
  };
  template <class Stage>
  using Holder = Stage;
  template <class Stage>
  static Stage& stage(Stage& holder) {
    return holder;
  }
};

}  // namespace ctu::pipeline
