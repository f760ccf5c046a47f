// result_queue: returns finished rays, one each result.interval cycles, compares the hit with the expected one bit for
// bit, and frees the context.
//
//   in   from_stack  finished rays
//   in   from_rays   rays that visited nothing
//   out  freed       emptied contexts
//   latency 0 behind its links, from_stack first
//   stalls: output_full, interval
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/result_queue.sv.
#pragma once

#include <vector>

#include "model/pipeline/context.h"
#include "model/pipeline/event_log.h"
#include "model/pipeline/link.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class ResultQueue {
 public:
  static constexpr const char* kName = "result_queue";
  typename Wiring::template In<SlotToken> from_stack, from_rays;
  typename Wiring::template Out<SlotToken> freed;

  ResultQueue(const UnitConfig& config, Contexts& contexts, Source& source, EventLog& log, const accel::Image& image)
      : contexts_(contexts),
        source_(source),
        log_(log),
        image_(image),
        interval_(static_cast<Cycle>(config.result.interval)) {}

  bool step(Cycle now) {
    const bool stack = from_stack.can_pop(now), rays = !stack && from_rays.can_pop(now);
    if (!stack && !rays) {
      account.set(Activity::Idle);
      return false;
    }
    if (next_return_ > now || !freed.can_push(now)) {
      account.set(next_return_ > now ? Activity::Interval : Activity::OutputFull);
      return false;
    }
    if (stack) {
      give_back(now, from_stack.front().slot);
      from_stack.pop(now);
    } else {
      give_back(now, from_rays.front().slot);
      from_rays.pop(now);
    }
    next_return_ = now + interval_;
    account.set(Activity::Busy);
    return true;
  }
  Cycle next_event(Cycle now) const { return next_return_ > now ? next_return_ : kNever; }

  std::uint64_t rays() const { return rays_; }
  std::uint64_t wrong_hits() const { return wrong_hits_; }
  const std::vector<WrongHit>& first_wrong() const { return first_wrong_; }

  Account account{kName, {Activity::OutputFull, Activity::Interval}};

 private:
  static constexpr std::size_t kWrongHitsKept = 16;

  void give_back(Cycle now, Slot slot) {
    const Context& context = contexts_[slot];
    const intersect::Hit returned = source_.finish(slot, image_);
    const intersect::Hit& expected = context.block->expected[context.index];
    if (!intersect::same_bits(returned, expected)) {
      ++wrong_hits_;
      if (first_wrong_.size() < kWrongHitsKept) first_wrong_.push_back({context.ray, expected, returned});
    }
    log_.add({now, context.ray, context.visits, true, {returned.primitive, 0, 0, 0}});
    ++rays_;
    contexts_.release(slot, now);
    freed.push(now, {slot});
  }

  Contexts& contexts_;
  Source& source_;
  EventLog& log_;
  const accel::Image& image_;
  Cycle interval_, next_return_ = 0;
  std::uint64_t rays_ = 0, wrong_hits_ = 0;
  std::vector<WrongHit> first_wrong_;
};

}  // namespace ctu::pipeline
