// scheduler: chooses which ready ray is issued next, one a cycle, to node_fetch or leaf_fetch by the kind of its
// reference.
//
//   in   from_stack, from_rays   rays with the reference they visit next
//   out  to_node_fetch, to_leaf_fetch
//   latency 1 (a ray that comes in cycle t can be issued in t + 1), one issue a cycle
//   stalls: output_full (rays are ready and the fetch stages of all of them are full)
//   policies: oldest, who has waited longest among those whose fetch stage can take one; round-robin, the next by
//   number
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/scheduler.sv.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/slot_set.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

/// References in the order of their arrival, with the number of the arrival.
class ArrivalQueue {
 public:
  struct Entry {
    RefToken token;
    std::uint32_t arrival;
  };
  explicit ArrivalQueue(int contexts)
      : ring_(std::bit_ceil(static_cast<unsigned>(contexts))), mask_(static_cast<std::uint32_t>(ring_.size() - 1)) {}
  bool empty() const { return head_ == tail_; }
  const Entry& front() const { return ring_[head_ & mask_]; }
  void pop() { ++head_; }
  void push(const Entry& entry) { ring_[tail_++ & mask_] = entry; }

 private:
  std::vector<Entry> ring_;
  std::uint32_t mask_, head_ = 0, tail_ = 0;
};

template <class Source, class Wiring>
class Scheduler {
 public:
  static constexpr const char* kName = "scheduler";
  typename Wiring::template In<RefToken> from_stack, from_rays;
  typename Wiring::template Out<RefToken> to_node_fetch, to_leaf_fetch;

  Scheduler(const UnitConfig& config, Contexts& contexts, Source& source)
      : contexts_(contexts),
        source_(source),
        policy_(config.scheduler.policy),
        node_queue_(contexts.count()),
        leaf_queue_(contexts.count()) {}

  bool step(Cycle now) {
    bool moved = false;
    const bool waiting = ready_ > 0;
    if (waiting) moved = policy_ == SchedulerPolicy::Oldest ? issue_oldest(now) : issue_round_robin(now);
    account.set(moved ? Activity::Busy : waiting ? Activity::OutputFull : Activity::Idle);
    moved |= accept(now, from_stack);
    moved |= accept(now, from_rays);
    return moved;
  }
  Cycle next_event(Cycle) const { return kNever; }
  std::uint64_t issued() const { return issued_; }
  std::uint64_t most_ready() const { return most_ready_; }

  Account account{kName, {Activity::OutputFull}};

 private:
  template <class In>
  bool accept(Cycle now, In& in) {
    if (!in.can_pop(now)) return false;
    const RefToken token = in.front();
    in.pop(now);
    contexts_.move(token.slot, now, Place::Scheduler);
    const bool leaf = accel::is_leaf(token.ref);
    if (policy_ == SchedulerPolicy::Oldest) {
      (leaf ? leaf_queue_ : node_queue_).push({token, arrivals_++});
    } else {
      (leaf ? leaf_set_ : node_set_).add(token.slot);
      token_of_[token.slot] = token;
    }
    if (++ready_ > most_ready_) most_ready_ = ready_;
    return true;
  }

  bool issue_oldest(Cycle now) {
    const bool node = !node_queue_.empty() & to_node_fetch.can_push(now);
    const bool leaf = !leaf_queue_.empty() & to_leaf_fetch.can_push(now);
    if (!node && !leaf) return false;
    // Numbers go round; at most kMaxContexts are out, so the sign of the difference orders them.
    const bool leaf_first =
        leaf && (!node || static_cast<std::int32_t>(leaf_queue_.front().arrival - node_queue_.front().arrival) < 0);
    ArrivalQueue& queue = leaf_first ? leaf_queue_ : node_queue_;
    const RefToken token = queue.front().token;
    queue.pop();
    issue(now, token);
    return true;
  }

  bool issue_round_robin(Cycle now) {
    const SlotSet* nodes = to_node_fetch.can_push(now) ? &node_set_ : nullptr;
    const SlotSet* leaves = to_leaf_fetch.can_push(now) ? &leaf_set_ : nullptr;
    const int slot = next_of_either(nodes, leaves, turn_);
    if (slot < 0) return false;
    const RefToken token = token_of_[static_cast<std::size_t>(slot)];
    (accel::is_leaf(token.ref) ? leaf_set_ : node_set_).remove(slot);
    turn_ = (slot + 1) & (kMaxContexts - 1);
    issue(now, token);
    return true;
  }

  void issue(Cycle now, const RefToken& token) {
    if (!token.of_packet) source_.visit(token.slot, token.ref);
    if (accel::is_leaf(token.ref))
      to_leaf_fetch.push(now, token);
    else
      to_node_fetch.push(now, token);
    --ready_;
    ++issued_;
  }

  Contexts& contexts_;
  Source& source_;
  SchedulerPolicy policy_;
  ArrivalQueue node_queue_, leaf_queue_;  // oldest
  SlotSet node_set_, leaf_set_;           // round-robin
  std::array<RefToken, kMaxContexts> token_of_{};
  int turn_ = 0;
  std::uint32_t arrivals_ = 0;
  std::uint64_t ready_ = 0, most_ready_ = 0, issued_ = 0;
};

}  // namespace ctu::pipeline
