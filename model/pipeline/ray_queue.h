// ray_queue: gives each ray of the feed, in order, a free context, and sets up its registers (reciprocal bounds, shear,
// the root). A ray that the unit does not accept goes straight to the result as a miss.
//
//   in   freed         contexts that result_queue has emptied
//   out  to_scheduler  the root of its tree, for each ray
//   out  to_result     rays that visit nothing
//   out  to_packets    instead of to_scheduler, where rays travel in packets: each ray that is valid or the last one of
//                      its packet
//   A ray names its tree by number; the roots of the image's trees lie in a table, read as the ray is taken.
//   latency ray_setup.latency, one ray each ray_setup.interval cycles (the directed divider is shared by the axes)
//   stalls: no_context, output_full
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/ray_queue.sv.
#pragma once

#include <memory>
#include <vector>

#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/pipe.h"
#include "model/pipeline/unit_config.h"
#include "model/pipeline/unit_image.h"
#include "model/reference/ray_block.h"

namespace ctu::pipeline {

template <class Source, class Wiring>
class RayQueue {
 public:
  static constexpr const char* kName = "ray_queue";
  typename Wiring::template In<SlotToken> freed;
  typename Wiring::template Out<RefToken> to_scheduler;
  typename Wiring::template Out<SlotToken> to_result;
  typename Wiring::template Out<JoinToken> to_packets;

  /// By the recording, where there are several trees.
  struct Counters {
    std::uint64_t local_rays = 0;                   ///< that walk another tree than that over the whole scene
    std::uint64_t own_tests = 0, global_tests = 0;  ///< unculled, of all rays in their trees, and in that one
  };

  RayQueue(const UnitConfig& config, const UnitImage& image, Contexts& contexts, Source& source,
           reference::RayFeed& feed, bool needs_steps)
      : image_(image),
        contexts_(contexts),
        source_(source),
        feed_(feed),
        packets_(feed.packets()),
        needs_steps_(needs_steps),
        interval_(static_cast<Cycle>(config.ray_setup.interval)),
        setup_(config.ray_setup.latency) {
    for (int slot = 0; slot < contexts.count(); ++slot) free_.push_back(static_cast<Slot>(slot));
    next_block();
  }

  bool step(Cycle now) {
    bool moved = false;
    const bool leaves = setup_.exit_ready(now);
    if (leaves && !leave(now)) {
      setup_.freeze(now);
      account.set(Activity::OutputFull);
    } else {
      moved = leaves;
      const bool waits = block_ != nullptr && setup_.can_enter(now);
      if (waits && free_count_ > 0) {
        take(now);
        moved = true;
      }
      account.set(waits && !moved && setup_.empty() ? Activity::NoContext
                  : moved || !setup_.empty()        ? Activity::Busy
                                                    : Activity::Idle);
    }
    if (freed.can_pop(now)) {
      free_[(first_free_ + free_count_++) % free_.size()] = freed.front().slot;
      freed.pop(now);
      moved = true;
    }
    return moved;
  }
  Cycle next_event(Cycle now) const { return setup_.next_event(now); }

  /// Every ray of the feed has been given a context.
  bool exhausted() const { return block_ == nullptr; }
  std::uint64_t rays_taken() const { return rays_taken_; }
  const Counters& counters() const { return counters_; }

  Account account{kName, {Activity::OutputFull, Activity::NoContext}};

 private:
  struct Prepared {
    Slot slot;
    bool valid;
    bool closes = false;  ///< the last ray of a packet
  };

  bool leave(Cycle now) {
    const Prepared& prepared = setup_.front();
    if (packets_.any()) return leave_to_packet(now, prepared);
    if (prepared.valid ? !to_scheduler.can_push(now) : !to_result.can_push(now)) return false;
    if (prepared.valid) {
      to_scheduler.push(now, {contexts_[prepared.slot].root, prepared.slot});
    } else {
      contexts_.move(prepared.slot, now, Place::Result);
      to_result.push(now, {prepared.slot});
    }
    setup_.leave(now);
    return true;
  }

  bool leave_to_packet(Cycle now, const Prepared& prepared) {
    const bool joins = prepared.valid || prepared.closes;
    if ((joins && !to_packets.can_push(now)) || (!prepared.valid && !to_result.can_push(now))) return false;
    if (joins) to_packets.push(now, {prepared.slot, prepared.valid, prepared.closes});
    if (!prepared.valid) {
      contexts_.move(prepared.slot, now, Place::Result);
      to_result.push(now, {prepared.slot});
    }
    setup_.leave(now);
    return true;
  }

  void take(Cycle now) {
    const Slot slot = free_[first_free_];
    first_free_ = (first_free_ + 1) % free_.size();
    --free_count_;
    Context& context = contexts_[slot];
    if (context.block != block_) context.block = block_;
    context.index = index_;
    context.ray = block_->first_ray + index_;
    context.any_hit = block_->rays[index_].kind == intersect::RayKind::AnyHit;
    context.visits = 0;
    context.root = image_.root(reference::tree_of(block_->trees, index_));
    count_trees();
    context.depth = context.spilled = 0;
    contexts_.occupy(slot, now);
    bool closes = false;
    if (packets_.any()) {
      context.packet = packet_;
      closes = index_ + 1 == block_->packets.first_ray[packet_ + 1];
      packet_ += closes;
    }
    setup_.enter(now, {slot, source_.begin(slot), closes}, interval_);
    ++rays_taken_;
    if (++index_ == block_->rays.size()) next_block();
  }

  void count_trees() {
    if (block_->trees.empty()) return;
    const reference::RayTree& tree = block_->trees[index_];
    counters_.local_rays += tree.tree != 0;
    counters_.own_tests += tree.own_tests;
    counters_.global_tests += tree.global_tests;
  }

  void next_block() {
    index_ = packet_ = 0;
    do {
      block_ = feed_.next();
    } while (block_ != nullptr && block_->rays.empty());
    if (block_ == nullptr) return;
    if (block_->expected.size() != block_->rays.size())
      throw Error("ray block at ray " + std::to_string(block_->first_ray), "expected hits are missing",
                  "record the trace again");
    if (needs_steps_ && block_->steps.rays() < block_->rays.size())
      throw Error("ray block at ray " + std::to_string(block_->first_ray), "recorded steps are missing",
                  "record them, or let the unit compute (exec)");
    check_trees();
    if (packets_.any()) check_packets();
  }

  /// Every ray of the block names a tree of the image.
  void check_trees() const {
    for (const reference::RayTree& tree : block_->trees)
      if (tree.tree >= image_.trees())
        throw Error("ray block at ray " + std::to_string(block_->first_ray),
                    "a ray walks tree " + std::to_string(tree.tree) + " of " + std::to_string(image_.trees()),
                    "record the trace again");
  }

  /// The block's packets are as the feed says.
  void check_packets() const {
    const reference::PacketList& list = block_->packets;
    const auto refuse = [&](const char* what) {
      throw Error("ray block at ray " + std::to_string(block_->first_ray), what, "record the trace again");
    };
    if (list.first_ray.back() != block_->rays.size()) refuse("its packets do not hold its rays");
    for (std::uint64_t p = 0; p < list.packets(); ++p)
      if (list.first_ray[p + 1] <= list.first_ray[p] ||
          list.first_ray[p + 1] - list.first_ray[p] > static_cast<std::uint32_t>(packets_.size))
        refuse("a packet has no rays, or more than there may be");
    if (needs_steps_ && !list.walked()) refuse("what its packets visit is missing");
  }

  const UnitImage& image_;
  Contexts& contexts_;
  Source& source_;
  reference::RayFeed& feed_;
  reference::PacketPlan packets_;
  bool needs_steps_;
  Cycle interval_;
  Pipe<Prepared> setup_;
  std::vector<Slot> free_;  // a ring
  std::size_t first_free_ = 0, free_count_ = static_cast<std::size_t>(contexts_.count());
  std::shared_ptr<const reference::RayBlock> block_;
  std::uint32_t index_ = 0, packet_ = 0;
  std::uint64_t rays_taken_ = 0;
  Counters counters_;
};

}  // namespace ctu::pipeline
