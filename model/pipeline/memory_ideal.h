// Memory with a fixed latency and one line each `interval` cycles.
#pragma once

#include <cstdint>
#include <vector>

#include "model/pipeline/cycle.h"
#include "model/pipeline/memory_client.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

class IdealMemory {
 public:
  explicit IdealMemory(const MemoryConfig& config)
      : latency_(static_cast<Cycle>(config.latency)), interval_(static_cast<Cycle>(config.interval)) {
    std::size_t places = 8;
    while (places < static_cast<std::size_t>(config.latency / config.interval) + kMaxOutstandingReads) places *= 2;
    ring_.resize(places);
  }

  bool can_accept(Cycle now) const { return now >= next_accept_; }
  void accept(Cycle now, const ClientRequest& request) {
    next_accept_ = now + interval_;
    if (!request.request.write)
      ring_[tail_++ & (ring_.size() - 1)] = {{request.client, request.request.id}, now + latency_};
  }
  bool answer_ready(Cycle now) const { return head_ != tail_ && ring_[head_ & (ring_.size() - 1)].due <= now; }
  const ClientAnswer& answer() const { return ring_[head_ & (ring_.size() - 1)].answer; }
  void take_answer() { ++head_; }
  bool work(Cycle) { return false; }
  /// Whether an answer is ready or work is to be done.
  bool due(Cycle now) const { return answer_ready(now); }
  bool empty() const { return head_ == tail_; }

  Cycle next_event(Cycle now) const {
    Cycle next = head_ == tail_ ? kNever : ring_[head_ & (ring_.size() - 1)].due;
    if (next_accept_ > now) next = earlier(next, next_accept_);
    return next;
  }

 private:
  struct Place {
    ClientAnswer answer;
    Cycle due = 0;
  };
  Cycle latency_, interval_, next_accept_ = 0;
  std::vector<Place> ring_;
  std::size_t head_ = 0, tail_ = 0;
};

}  // namespace ctu::pipeline
