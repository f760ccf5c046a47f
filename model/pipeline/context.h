// The contexts: a register file with one place for each ray in flight. A ray has at most one node or leaf outstanding,
// so a context is touched by one stage at a time: the one that holds the token with its number.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "model/pipeline/accounting.h"
#include "model/pipeline/cycle.h"
#include "model/pipeline/tokens.h"
#include "model/reference/ray_block.h"

namespace ctu::pipeline {

/// What every source of outcomes needs of a ray. Computed values live in the source's own registers (exec_source.h).
struct Context {
  std::uint64_t ray = 0;  ///< number in the whole trace
  std::shared_ptr<const reference::RayBlock> block;
  std::uint32_t index = 0;   ///< of the ray in its block
  std::uint32_t packet = 0;  ///< of the ray's packet in its block, where rays travel in packets
  std::uint32_t visits = 0;  ///< nodes and leaves visited so far
  accel::ChildRef root = 0;  ///< of the ray's tree
  Cycle entered = 0;         ///< cycle it took the context
  bool any_hit = false;
  bool in_flight = false;
  std::uint16_t depth = 0;    ///< stack entries, spilled ones included
  std::uint16_t spilled = 0;  ///< of those, how many lie in memory (the oldest)
};

/// Where a ray is, and since which cycle.
struct Stay {
  Cycle since = 0;
  Place place = Place::RaySetup;
};

class Contexts {
 public:
  explicit Contexts(int count) : contexts_(static_cast<std::size_t>(count)), stays_(contexts_.size()) {}

  int count() const { return static_cast<int>(contexts_.size()); }
  Context& operator[](int slot) { return contexts_[static_cast<std::size_t>(slot)]; }
  const Context& operator[](int slot) const { return contexts_[static_cast<std::size_t>(slot)]; }

  void occupy(int slot, Cycle now) {
    Context& context = (*this)[slot];
    context.entered = now;
    stay(slot) = {now, Place::RaySetup};
    context.in_flight = true;
    change_occupancy(now, +1);
    if (occupied_ > most_occupied_) most_occupied_ = occupied_;
  }
  /// The ray comes to `place`; the cycles since the last change are charged to where it was.
  void move(int slot, Cycle now, Place place) {
    Stay& stay = this->stay(slot);
    charge(stay.place, now - stay.since);
    stay = {now, place};
  }
  /// Cycles of rays that are charged otherwise than by move().
  void charge(Place place, Cycle cycles) { cycles_[static_cast<int>(place)] += cycles; }
  Stay& stay(int slot) { return stays_[static_cast<std::size_t>(slot)]; }
  const Stay& stay(int slot) const { return stays_[static_cast<std::size_t>(slot)]; }
  /// The ray leaves; its time in the unit, in cycles.
  std::uint64_t release(int slot, Cycle now) {
    Context& context = (*this)[slot];
    charge(stay(slot).place, now - stay(slot).since);
    context.in_flight = false;
    change_occupancy(now, -1);
    latency_sum_ += now - context.entered;
    return now - context.entered;
  }

  std::uint64_t cycles_at(Place place) const { return cycles_[static_cast<int>(place)]; }
  std::uint64_t latency_sum() const { return latency_sum_; }
  /// Sum over cycles of occupied contexts, counted on its own for Little's law.
  std::uint64_t occupied_cycles() const { return occupied_cycles_; }
  int occupied() const { return occupied_; }
  int most_occupied() const { return most_occupied_; }

 private:
  void change_occupancy(Cycle now, int change) {
    occupied_cycles_ += static_cast<std::uint64_t>(occupied_) * (now - occupied_since_);
    occupied_since_ = now;
    occupied_ += change;
  }

  std::vector<Context> contexts_;
  std::vector<Stay> stays_;  ///< by context; apart because every stage writes them
  std::array<std::uint64_t, kPlaces> cycles_{};
  std::uint64_t latency_sum_ = 0, occupied_cycles_ = 0;
  Cycle occupied_since_ = 0;
  int occupied_ = 0, most_occupied_ = 0;
};

}  // namespace ctu::pipeline
