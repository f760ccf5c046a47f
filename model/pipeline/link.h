// The link between two stages: a FIFO of two entries whose full and empty are judged on the state at the start of the
// cycle. What was pushed in a cycle can be popped in the next one, the room made by a pop can be used in the next one;
// so the order in which stages are stepped within a cycle cannot matter, and the hardware twin is a FIFO of two
// registers with registered valid and ready. One push and one pop a cycle at most.
#pragma once

#include <cassert>
#include <cstdint>

#include "model/pipeline/backpressure.h"
#include "model/pipeline/cycle.h"

namespace ctu::pipeline {

/// Each of the two places keeps from which cycle on its token can be popped, and from which on it is free: every stage
/// asks in every cycle, and nothing branches on how full the link is, which no processor predicts.
template <class T>
class Link {
 public:
  bool can_pop(Cycle now) const { return place_[head_].ready_from <= now; }
  bool can_push(Cycle now) const { return place_[tail_].free_from <= now; }
  const T& front() const { return place_[head_].token; }
  void pop(Cycle now) {
    place_[head_].ready_from = kNever;
    place_[head_].free_from = now + 1;
    head_ ^= 1u;
  }
  void push(Cycle now, const T& token) {
    place_[tail_].ready_from = now + 1;
    place_[tail_].free_from = kNever;
    place_[tail_].token = token;
    tail_ ^= 1u;
  }
  int occupancy() const { return (place_[0].ready_from != kNever) + (place_[1].ready_from != kNever); }

 private:
  struct Place {
    Cycle ready_from = kNever, free_from = 0;
    T token{};
  };
  std::uint32_t head_ = 0, tail_ = 0;
  Place place_[2];
};

/// How stages and links are joined. A stage names its ports Wiring::In<T> and Wiring::Out<T> and knows nothing else, so
/// the same stage runs over plain links, over links that refuse at random, and over SystemC signals (model/unit).
struct PlainWiring {
  /// The link lies within the stage that pops it: one pointer less to follow each cycle.
  template <class T>
  struct In {
    Link<T> link;
    bool can_pop(Cycle now) const { return link.can_pop(now); }
    const T& front() const { return link.front(); }
    void pop(Cycle now) { link.pop(now); }
  };
  template <class T>
  struct Out {
    Link<T>* link = nullptr;
    bool can_push(Cycle now) const { return link->can_push(now); }
    void push(Cycle now, const T& value) { link->push(now, value); }
  };
  /// What holds a stage: here the stage itself.
  template <class Stage>
  using Holder = Stage;
  template <class Stage>
  static Stage& stage(Stage& holder) {
    return holder;
  }
};

/// The same over links that refuse as Backpressure says, and that watch over the rule of one push and one pop a cycle.
struct StallingWiring {
  template <class T>
  struct In {
    Link<T> link;
    const Backpressure* backpressure = nullptr;
    int number = 0;
    Cycle last_pop = kNever;
    bool can_pop(Cycle now) const { return link.can_pop(now) && !backpressure->refuses(number, Side::Pop, now); }
    const T& front() const { return link.front(); }
    void pop(Cycle now) {
      assert(last_pop != now && "one pop a cycle");
      last_pop = now;
      link.pop(now);
    }
  };
  template <class T>
  struct Out {
    Link<T>* link = nullptr;
    const Backpressure* backpressure = nullptr;
    int number = 0;
    Cycle last_push = kNever;
    bool can_push(Cycle now) const { return link->can_push(now) && !backpressure->refuses(number, Side::Push, now); }
    void push(Cycle now, const T& value) {
      assert(last_push != now && "one push a cycle");
      last_push = now;
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
