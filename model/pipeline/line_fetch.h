// What node_fetch, leaf_fetch and table_fetch do: bring the lines that hold a node, a leaf, or rows of tables. `Lines`
// says which lines a token needs (span_lines.h, table_lines.h).
//
//   in   requests   tokens
//   in   fills      lines that memory has answered, by miss register
//   out  misses     lines asked of memory; the id is the miss register
//   out  done       tokens all of whose lines are there, in the order of completion
//   out  to_packets the same of tokens that are a packet's; only of node_fetch
//   A token taken in cycle t looks up its first line in t, and up to `ports` lines a cycle. When the last of n lines
//   has been looked up, in cycle t + ceil(n / ports) - 1, and all of them hit, the data are read hit_latency cycles
//   later, and the token leaves in the cycle behind that. One new line a cycle can be asked of memory. A line that
//   misses takes a miss register and goes to memory, or joins the register that waits for the same line. A line that
//   comes back takes the tag port for its cycle; contexts that waited for nothing else can leave in the next cycle, one
//   a cycle, in turn by number.
//   A token that needs no line takes one turn of the lookup and can leave in the next cycle. Where lines are known only
//   from what the lines before hold, the token is looked up a second time, from the cycle on in which it could
//   otherwise leave, before new tokens.
//   stalls: mshrs_full, memory_port_full, fill_port, output_full, memory
//
// Stated for both twins in docs/unit.md. Twin in gates: rtl/line_fetch.sv.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "model/pipeline/cache.h"
#include "model/pipeline/context.h"
#include "model/pipeline/link.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

/// The way of tokens that are a packet's.
template <class Lines, class Wiring, bool kServesPackets = Lines::kServesPackets>
struct PacketPort {};
template <class Lines, class Wiring>
struct PacketPort<Lines, Wiring, true> {
  typename Wiring::template Out<typename Lines::Done> to_packets;
};

template <class Lines, class Wiring>
class LineFetch : public PacketPort<Lines, Wiring> {
 public:
  using Token = typename Lines::Token;
  using Done = typename Lines::Done;
  typename Wiring::template In<Token> requests;
  typename Wiring::template In<MemoryResponse> fills;
  typename Wiring::template Out<MemoryRequest> misses;
  typename Wiring::template Out<Done> done;

  struct Counters {
    std::uint64_t lookups = 0, hits = 0, merges = 0, fills = 0, visits = 0, bytes = 0;
  };

  LineFetch(std::string_view name, const CacheConfig& cache, int line_bytes, Lines lines, Contexts& contexts,
            Place hit_place, Place miss_place)
      : account{name,
                {Activity::OutputFull, Activity::MshrsFull, Activity::MemoryPortFull, Activity::FillPort,
                 Activity::Memory}},
        lines_(std::move(lines)),
        contexts_(contexts),
        hit_place_(hit_place),
        miss_place_(miss_place),
        line_shift_(std::countr_zero(static_cast<unsigned>(line_bytes))),
        ports_(cache.ports),
        hit_latency_(static_cast<Cycle>(cache.hit_latency)),
        tags_(cache, line_bytes),
        mshrs_(cache.mshrs),
        reading_(std::bit_ceil(static_cast<unsigned>(contexts.count()))),
        ring_mask_(static_cast<std::uint32_t>(reading_.size() - 1)),
        again_(Lines::kRounds == 1 ? 0 : reading_.size()) {}

  bool step(Cycle now) {
    if (nothing_to_do(now)) {  // most cycles, so settled at once
      account.set(activity(Activity::Idle, false, false));
      return false;
    }
    return work(now);
  }
  /// The token's lines are in the cache as if it had just been looked up; takes no time. Lines under way stay so.
  void warm(const Token& token) {
    Lines lines = lines_;  // a lookup may be at work
    lines.start(token);
    do {
      if (!tags_.touch(lines.current()) && mshrs_.find(lines.current()) < 0) tags_.install(lines.current());
    } while (lines.next());
  }
  Cycle next_event(Cycle) const {
    return reading_head_ == reading_tail_ ? kNever : reading_[reading_head_ & ring_mask_].due;
  }

  const Counters& counters() const { return counters_; }
  const CacheTags& tags() const { return tags_; }
  const MissRegisters& mshrs() const { return mshrs_; }

  Account account;

 private:
  bool nothing_to_do(Cycle now) const {
    return !active_ && !can_start_again(now) && !requests.can_pop(now) && !fills.can_pop(now) && finished_.empty() &&
           next_event(now) > now;
  }

  [[gnu::noinline]] bool work(Cycle now) {
    bool blocked_by_output = false;
    bool moved = present(now, blocked_by_output);
    const bool filled = fill(now);
    moved |= filled;
    moved |= read_data(now);
    Activity lookup = Activity::Idle;
    if (filled) {
      if (active_ || can_start_again(now) || requests.can_pop(now)) lookup = Activity::FillPort;
    } else {
      lookup = look_up(now);
      moved |= lookup == Activity::Busy || looked_up_something_;
    }
    account.set(activity(lookup, moved, blocked_by_output));
    return moved;
  }

  bool present(Cycle now, bool& blocked) {
    if (finished_.empty()) return false;
    if constexpr (Lines::kServesPackets) {
      if (packets_finished_ != 0 && Lines::of_packet(token_of_[static_cast<std::size_t>(finished_.next_from(turn_))])) {
        blocked = !present_to(now, this->to_packets);
        packets_finished_ -= blocked ? 0 : 1;
        return !blocked;
      }
    }
    blocked = !present_to(now, done);
    return !blocked;
  }

  template <class Out>
  bool present_to(Cycle now, Out& out) {
    if (!out.can_push(now)) return false;
    const int slot = finished_.next_from(turn_);
    finished_.remove(slot);
    turn_ = (slot + 1) & (kMaxContexts - 1);
    out.push(now, Lines::done(token_of_[static_cast<std::size_t>(slot)]));
    return true;
  }

  bool fill(Cycle now) {
    if (!fills.can_pop(now)) return false;
    LineNumber line;
    const SlotSet waiters = mshrs_.release(fills.front().id, line);
    fills.pop(now);
    tags_.install(line);
    ++counters_.fills;
    waiters.for_each([&](int slot) { arrived(now, slot); });
    return true;
  }

  bool read_data(Cycle now) {
    if (reading_head_ == reading_tail_ || reading_[reading_head_ & ring_mask_].due > now) return false;
    arrived(now, reading_[reading_head_++ & ring_mask_].slot);
    return true;
  }

  /// One of the things that the context waits for is there: a line from memory, or the end of its data reads.
  void arrived(Cycle now, int slot) {
    if (--waiting_for_[static_cast<std::size_t>(slot)] != 0) return;
    if constexpr (Lines::kRounds > 1) {
      if (lines_.needs_more(token_of_[static_cast<std::size_t>(slot)])) {
        again_[again_tail_++ & ring_mask_] = {static_cast<Slot>(slot), now + 1};
        return;
      }
    }
    if constexpr (Lines::kServesPackets)
      packets_finished_ += Lines::of_packet(token_of_[static_cast<std::size_t>(slot)]);
    finished_.add(slot);
  }

  /// A token whose second lines can be looked up.
  bool can_start_again(Cycle now) const {
    if constexpr (Lines::kRounds == 1) return false;
    return again_head_ != again_tail_ && again_[again_head_ & ring_mask_].due <= now;
  }

  void start_again() {
    if constexpr (Lines::kRounds > 1) start(token_of_[again_[again_head_++ & ring_mask_].slot]);
  }

  /// Busy: went on as far as the ports allow; Idle: nothing to look up; else why it stands.
  Activity look_up(Cycle now) {
    looked_up_something_ = false;
    if (!active_) {
      if (can_start_again(now)) {
        start_again();
      } else {
        if (!requests.can_pop(now)) return Activity::Idle;
        accept(now, requests.front());
        requests.pop(now);
      }
      looked_up_something_ = true;  // the token at least has moved
      if (!active_) return Activity::Busy;
    }
    for (int port = 0; port < ports_; ++port) {
      const Activity outcome = look_up_line(now);
      if (outcome != Activity::Busy) return outcome;
      looked_up_something_ = true;
      if (!lines_.next()) {
        reading_[reading_tail_++ & ring_mask_] = {slot_, now + hit_latency_};
        active_ = false;
        break;
      }
    }
    return Activity::Busy;
  }

  void accept(Cycle now, const Token& token) {
    contexts_.move(token.slot, now, hit_place_);
    token_of_[token.slot] = token;
    ++counters_.visits;
    start(token);
  }

  void start(const Token& token) {
    const std::uint64_t bytes = lines_.start(token);
    if constexpr (Lines::kMayNeedNone) {
      if (bytes == 0) {
        finished_.add(token.slot);
        return;
      }
    }
    active_ = true;
    slot_ = token.slot;
    waiting_for_[slot_] = 1;  // the end of its data reads
    counters_.bytes += bytes;
  }

  Activity look_up_line(Cycle now) {
    const LineNumber line = lines_.current();
    if (tags_.touch(line)) {
      ++counters_.hits;
    } else {
      int number = mshrs_.find(line);
      if (number >= 0) {
        ++counters_.merges;
      } else {
        if (mshrs_.full()) return Activity::MshrsFull;
        if (last_request_ == now || !misses.can_push(now)) return Activity::MemoryPortFull;
        last_request_ = now;
        number = mshrs_.allocate(line);
        misses.push(now, {line << line_shift_, static_cast<std::uint16_t>(number), false});
      }
      mshrs_.wait(number, slot_);
      ++waiting_for_[slot_];
      contexts_.stay(slot_).place = miss_place_;
    }
    ++counters_.lookups;
    return Activity::Busy;
  }

  Activity activity(Activity lookup, bool moved, bool blocked_by_output) const {
    if (lookup != Activity::Idle && lookup != Activity::Busy) return lookup;
    if (lookup == Activity::Busy || moved) return Activity::Busy;
    if (blocked_by_output) return Activity::OutputFull;
    if (reading_head_ != reading_tail_ || !finished_.empty()) return Activity::Busy;
    return mshrs_.none_in_use() ? Activity::Idle : Activity::Memory;
  }

  struct Read {
    Slot slot;
    Cycle due;
  };

  Lines lines_;
  Contexts& contexts_;
  Place hit_place_, miss_place_;
  int line_shift_, ports_;
  Cycle hit_latency_;
  CacheTags tags_;
  MissRegisters mshrs_;
  bool active_ = false, looked_up_something_ = false;
  Slot slot_ = 0;
  Cycle last_request_ = kNever;
  std::vector<Read> reading_;  // a ring with a place for every context: small, to stay near
  std::uint32_t ring_mask_;
  std::uint32_t reading_head_ = 0, reading_tail_ = 0;
  std::vector<Read> again_;  // likewise, of tokens with more lines to come
  std::uint32_t again_head_ = 0, again_tail_ = 0;
  std::array<Token, kMaxContexts> token_of_{};
  std::array<std::uint8_t, kMaxContexts> waiting_for_{};
  SlotSet finished_;
  int packets_finished_ = 0;  ///< of those, a packet's
  int turn_ = 0;
  Counters counters_;
};

}  // namespace ctu::pipeline
