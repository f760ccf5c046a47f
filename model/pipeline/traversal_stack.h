// traversal_stack: the short stack of every context, on chip, spilled to memory exactly, never dropped.
//
//   in   sorted     surviving children of a node, nearest first
//   in   leaf_done  rays whose leaf is finished
//   in   refills    spilled entries that have come back
//   in   starts     rays that begin with the entries of their packet
//   out  to_scheduler  rays with their next reference
//   out  to_result     rays whose stack is empty, or that are finished
//   out  spills        writes of the oldest entries, reads of the youngest spilled ones
//   out  released      packets whose last ray has begun
//   One ray at a time. A token taken in cycle t is worked on from t + 1:
//     s survivors: pushes up to push_width a cycle, farthest first; the nearest goes straight to the scheduler, in the
//       cycle of the last push, so s <= push_width + 1 take one cycle. When the context's entries are full, the oldest
//       spill_batch of them are written to memory first, one cycle.
//     none: pops one entry a cycle; those beyond the best hit are dropped, the first other one goes to the scheduler.
//     When
//       none is on chip but some are spilled, a batch is read back, and the ray waits aside while others are served.
//     a ray that begins: pushes its packet's entries up to push_width a cycle, farthest first; the nearest is popped
//       (or dropped) in the cycle of the last push, so e <= push_width + 1 entries take one cycle.
//   The next token is taken in the last cycle of the one before. Inputs take turns.
//   stalls: output_full, spill
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/traversal_stack.sv.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/pipeline/context.h"
#include "model/pipeline/event_log.h"
#include "model/pipeline/link.h"
#include "model/pipeline/memory_map.h"
#include "model/pipeline/packets.h"
#include "model/pipeline/unit_config.h"
#include "model/pipeline/unit_image.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class TraversalStack {
 public:
  static constexpr const char* kName = "traversal_stack";
  typename Wiring::template In<NodeToken> sorted;
  typename Wiring::template In<LeafDone> leaf_done;
  typename Wiring::template In<MemoryResponse> refills;
  typename Wiring::template In<StartToken> starts;
  typename Wiring::template Out<RefToken> to_scheduler;
  typename Wiring::template Out<SlotToken> to_result;
  typename Wiring::template Out<MemoryRequest> spills;
  typename Wiring::template Out<PacketToken> released;

  struct Counters {
    std::uint64_t pushes = 0, pops = 0, dropped = 0, spills = 0, refills = 0;
    int deepest = 0;
  };

  TraversalStack(const UnitConfig& config, Contexts& contexts, const Packets& packets, Source& source, EventLog& log,
                 const UnitImage& image)
      : contexts_(contexts),
        packets_(packets),
        source_(source),
        log_(log),
        image_(image),
        entries_(config.stack.entries),
        push_width_(config.stack.push_width),
        spill_batch_(config.stack.spill_batch),
        can_spill_(image.stack_bound() > config.stack.entries),
        has_packets_(image.packet_entries() > 0),
        map_(config, image),
        bound_(static_cast<std::size_t>(image.stack_bound()) + 1),
        refs_(bound_ * static_cast<std::size_t>(contexts.count())) {}

  bool step(Cycle now) {
    bool moved = false;
    Activity activity = Activity::Idle;
    if (job_ != Job::None) {
      activity = work(now);
      moved = activity == Activity::Busy;
    }
    if (job_ == Job::None && take(now)) {
      moved = true;
      activity = Activity::Busy;
    }
    account.set(activity);
    return moved;
  }
  Cycle next_event(Cycle) const { return kNever; }

  const Counters& counters() const { return counters_; }

  Account account{kName, {Activity::OutputFull, Activity::Spill}};

 private:
  enum class Job : std::uint8_t { None, Push, Pop, Finish, Start };
  static constexpr int kInputs = 4;

  accel::ChildRef& entry(Slot slot, int position) { return refs_[slot * bound_ + static_cast<std::size_t>(position)]; }

  /// One cycle on the current job: Busy when it went on, else why it stands.
  Activity work(Cycle now) {
    switch (job_) {
      case Job::Push:
        return push(now);
      case Job::Pop:
        return pop(now);
      case Job::Start:
        return start(now);
      default:
        return finish(now);
    }
  }

  Activity push(Cycle now) {
    Context& context = contexts_[slot_];
    int pushed = 0;
    for (; to_push_ > 0 && pushed < push_width_; ++pushed, --to_push_) {
      if (context.depth - context.spilled == entries_) {
        if (pushed > 0) return Activity::Busy;  // spills in the next cycle
        return spill(now, context);
      }
      const int lane = (order_ >> (2 * to_push_)) & 3;
      entry(slot_, context.depth) = image_.child(node_, lane);
      source_.pushed(slot_, context.depth, lane);
      ++context.depth;
      ++counters_.pushes;
    }
    if (context.depth > counters_.deepest) counters_.deepest = context.depth;
    if (to_push_ > 0) return Activity::Busy;
    if (!to_scheduler.can_push(now)) return pushed > 0 ? Activity::Busy : Activity::OutputFull;
    source_.goes_to_child(slot_, order_ & 3);
    to_scheduler.push(now, {image_.child(node_, order_ & 3), slot_});
    job_ = Job::None;
    return Activity::Busy;
  }

  /// The packet's entries come onto the stack as survivors do. The nearest one never needs a place there: it is popped
  /// at once.
  Activity start(Cycle now) {
    Context& context = contexts_[slot_];
    const reference::EntryList& entries = packets_[start_.packet].entries;
    int pushed = 0;
    for (; to_push_ > 0 && pushed < push_width_; ++pushed, --to_push_) {
      if (context.depth - context.spilled == entries_) {
        if (pushed > 0) return Activity::Busy;  // spills in the next cycle
        return spill(now, context);
      }
      entry(slot_, context.depth) = entries[to_push_].ref;
      source_.started(slot_, context.depth, entries[to_push_]);
      ++context.depth;
      ++counters_.pushes;
    }
    if (context.depth > counters_.deepest) counters_.deepest = context.depth;
    if (to_push_ > 0) return Activity::Busy;
    if (start_.last && !released.can_push(now)) return pushed > 0 ? Activity::Busy : Activity::OutputFull;
    const Activity begun = start_nearest(now, entries);
    if (begun != Activity::Busy) return pushed > 0 ? Activity::Busy : begun;
    if (start_.last) released.push(now, {start_.packet});
    return Activity::Busy;
  }

  Activity start_nearest(Cycle now, const reference::EntryList& entries) {
    if (entries.count() == 0) return finish(now);
    const int place = contexts_[slot_].depth;
    if (!decided_) {
      source_.started(slot_, place, entries[0]);
      source_.begin_pop(slot_);
      dropping_ = source_.drops(slot_, place);
      decided_ = true;
    }
    if (dropping_) {
      ++counters_.dropped;
      job_ = Job::Pop;
    } else {
      if (!to_scheduler.can_push(now)) return Activity::OutputFull;
      to_scheduler.push(now, {entries[0].ref, slot_});
      job_ = Job::None;
    }
    decided_ = false;
    return Activity::Busy;
  }

  /// Writes the oldest entries on chip to memory.
  Activity spill(Cycle now, Context& context) {
    if (!spills.can_push(now)) return Activity::Spill;
    spills.push(now, {spill_address(context.spilled), slot_, true});
    context.spilled = static_cast<std::uint16_t>(context.spilled + spill_batch_);
    ++counters_.spills;
    return Activity::Busy;
  }

  Activity pop(Cycle now) {
    Context& context = contexts_[slot_];
    if (context.depth == 0) return finish(now);
    if (context.depth == context.spilled) return refill(now, context);
    const int top = context.depth - 1;
    if (!decided_) {
      dropping_ = source_.drops(slot_, top);
      decided_ = true;
    }
    if (dropping_) {
      ++counters_.dropped;
    } else {
      if (!to_scheduler.can_push(now)) return Activity::OutputFull;
      source_.goes_to_entry(slot_, top);
      to_scheduler.push(now, {entry(slot_, top), slot_});
      job_ = Job::None;
    }
    --context.depth;
    ++counters_.pops;
    decided_ = false;
    return Activity::Busy;
  }

  /// Asks for the youngest batch in memory; the ray waits aside.
  Activity refill(Cycle now, Context& context) {
    if (!spills.can_push(now)) return Activity::Spill;
    spills.push(now, {spill_address(context.spilled - spill_batch_), slot_, false});
    contexts_.move(slot_, now, Place::StackRefill);
    ++counters_.refills;
    job_ = Job::None;
    return Activity::Busy;
  }

  Activity finish(Cycle now) {
    if (!to_result.can_push(now)) return Activity::OutputFull;
    contexts_.move(slot_, now, Place::Result);
    to_result.push(now, {slot_});
    job_ = Job::None;
    return Activity::Busy;
  }

  bool take(Cycle now) {
    const unsigned offered = unsigned{sorted.can_pop(now)} | unsigned{leaf_done.can_pop(now)} << 1 |
                             unsigned{can_spill_ && refills.can_pop(now)} << 2 |
                             unsigned{has_packets_ && starts.can_pop(now)} << 3;
    if (offered == 0) return false;
    const unsigned twice = offered | offered << kInputs;  // from turn_ on, going round
    const int input = (turn_ + std::countr_zero(twice >> turn_)) % kInputs;
    turn_ = (input + 1) % kInputs;
    take_from(input, now);
    return true;
  }

  void take_from(int input, Cycle now) {
    if (input == 0) {
      const NodeToken token = sorted.front();
      sorted.pop(now);
      take_node(now, token);
    } else if (input == 1) {
      const LeafDone token = leaf_done.front();
      leaf_done.pop(now);
      begin(now, token.slot, token.finished ? Job::Finish : Job::Pop);
      if (!token.finished) source_.begin_pop(slot_);
    } else if (input == 3) {
      start_ = starts.front();
      starts.pop(now);
      begin(now, start_.slot, Job::Start);
      to_push_ = packets_[start_.packet].entries.count() - 1;
    } else {
      const auto slot = static_cast<Slot>(refills.front().id);
      refills.pop(now);
      contexts_[slot].spilled = static_cast<std::uint16_t>(contexts_[slot].spilled - spill_batch_);
      begin(now, slot, Job::Pop);  // goes on where it was
    }
  }

  void take_node(Cycle now, const NodeToken& token) {
    begin(now, token.slot, token.survivors == 0 ? Job::Pop : Job::Push);
    Context& context = contexts_[slot_];
    const reference::Step step = source_.finish_visit(slot_);
    log_.add({now, context.ray, context.visits, false, step});
    ++context.visits;
    node_ = step.ref;
    order_ = token.order;
    to_push_ = std::popcount(token.survivors) - 1;
    if (job_ == Job::Pop) source_.begin_pop(slot_);
  }

  void begin(Cycle now, Slot slot, Job job) {
    slot_ = slot;
    job_ = job;
    decided_ = false;
    contexts_.move(slot, now, Place::Stack);
  }

  /// Of the batch that begins with entry `position`. It crosses no line, as all sizes are powers of two.
  std::uint64_t spill_address(int position) const {
    return map_.spill_base + slot_ * map_.spill_region + static_cast<std::uint64_t>(position) * map_.entry_bytes;
  }

  Contexts& contexts_;
  const Packets& packets_;
  Source& source_;
  EventLog& log_;
  const UnitImage& image_;
  int entries_, push_width_, spill_batch_;
  bool can_spill_, has_packets_;
  MemoryMap map_;
  std::size_t bound_;
  std::vector<accel::ChildRef> refs_;

  Job job_ = Job::None;
  Slot slot_ = 0;
  std::uint32_t node_ = 0;
  std::uint8_t order_ = 0;
  int to_push_ = 0;  ///< survivors number 1 .. to_push_ are still to be pushed
  bool decided_ = false, dropping_ = false;
  int turn_ = 0;
  StartToken start_;
  Counters counters_;
};

}  // namespace ctu::pipeline
