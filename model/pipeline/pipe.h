// The inside of a pipelined stage: `latency` registers in a row with one enable. A token that enters in cycle t leaves
// in cycle t + latency; when it cannot leave, the whole row stands still, bubbles included, and nothing enters.
#pragma once

#include <cstdint>
#include <vector>

#include "model/pipeline/cycle.h"

namespace ctu::pipeline {

template <class T>
class Pipe {
 public:
  explicit Pipe(int latency) : latency_(static_cast<Cycle>(latency)) {
    std::size_t places = 8;
    while (places < static_cast<std::size_t>(latency) + 8) places *= 2;
    ring_.resize(places);
    mask_ = static_cast<std::uint32_t>(places - 1);
  }

  Cycle latency() const { return latency_; }
  bool empty() const { return head_ == tail_; }
  /// A token stands in the last register.
  bool exit_ready(Cycle now) const { return head_due_ <= now - frozen_total_; }
  /// The first register is free: the token before has had its `occupies` cycles.
  bool can_enter(Cycle now) const { return entry_free_ + frozen_total_ <= now; }

  const T& front() const { return ring_[head_ & mask_].token; }
  /// The enable is off in this cycle, as the token in the last register cannot leave.
  void freeze(Cycle now) {
    if (frozen_since_ == kNever) frozen_since_ = now;
  }
  T leave(Cycle now) {
    if (frozen_since_ != kNever) {
      frozen_total_ += now - frozen_since_;
      frozen_since_ = kNever;
    }
    Place& last = ring_[head_++ & mask_];
    last.due = kNever;
    head_due_ = ring_[head_ & mask_].due;
    return last.token;
  }
  /// Enters and keeps the entrance for `occupies` cycles; the token moves on at the end of them.
  void enter(Cycle now, const T& token, Cycle occupies = 1) {
    const Cycle pipe_now = now - frozen_total_;
    const Cycle due = pipe_now + occupies - 1 + latency_;
    head_due_ = earlier(head_due_, due);
    ring_[tail_++ & mask_] = {token, due};
    entry_free_ = pipe_now + occupies;
  }
  /// The next cycle after `now` in which something changes by itself: a token reaches the last register or the entrance
  /// becomes free.
  Cycle next_event(Cycle now) const {
    if (frozen_since_ != kNever) return kNever;
    Cycle next = empty() ? kNever : head_due_ + frozen_total_;
    if (!can_enter(now)) next = earlier(next, entry_free_ + frozen_total_);
    return next;
  }

 private:
  struct Place {
    T token{};
    Cycle due = kNever;  // in the pipe's own time, which stands still while it is frozen; kNever: no token
  };
  Cycle latency_;
  std::vector<Place> ring_;
  std::uint32_t mask_ = 0, head_ = 0, tail_ = 0;
  Cycle head_due_ = kNever;  // of the oldest token, beside the ring because every cycle asks for it
  Cycle entry_free_ = 0, frozen_total_ = 0, frozen_since_ = kNever;
};

}  // namespace ctu::pipeline
