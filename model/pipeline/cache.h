// What both fetch stages are made of: the tags of a set-associative cache, and the miss registers (MSHRs).
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/pipeline/slot_set.h"
#include "model/pipeline/unit_config.h"

namespace ctu::pipeline {

using LineNumber = std::uint64_t;  ///< byte address / line bytes

/// Tags with least-recently-used replacement. Without lines, everything misses and nothing is kept. A set is kept in
/// the order of use, the last used line first: which way of the hardware's set holds a line changes nothing outside.
class CacheTags {
 public:
  CacheTags(const CacheConfig& config, int line_bytes)
      : ways_(config.bytes == 0 ? 0 : static_cast<std::size_t>(config.ways)),
        set_mask_(config.bytes == 0 ? 0 : static_cast<LineNumber>(config.bytes / line_bytes / config.ways - 1)),
        lines_(config.bytes == 0 ? 0 : static_cast<std::size_t>(config.bytes / line_bytes), kNoLine) {}

  /// A hit makes the line the most recently used of its set.
  bool touch(LineNumber line) {
    LineNumber* set = set_of(line);
    for (std::size_t w = 0; w < ways_; ++w)
      if (set[w] == line) {
        put_first(set, w, line);
        return true;
      }
    return false;
  }
  /// Takes a line in, in the place of the least recently used of its set.
  void install(LineNumber line) {
    if (ways_ == 0) return;
    LineNumber* set = set_of(line);
    if (set[ways_ - 1] != kNoLine) ++evictions_;
    put_first(set, ways_ - 1, line);
  }
  std::uint64_t evictions() const { return evictions_; }

 private:
  static constexpr LineNumber kNoLine = ~LineNumber{0};
  LineNumber* set_of(LineNumber line) { return lines_.data() + (line & set_mask_) * ways_; }
  /// What stands before `place` moves back by one.
  static void put_first(LineNumber* set, std::size_t place, LineNumber line) {
    for (; place > 0; --place) set[place] = set[place - 1];
    set[0] = line;
  }

  std::size_t ways_;
  LineNumber set_mask_;
  std::vector<LineNumber> lines_;
  std::uint64_t evictions_ = 0;
};

inline constexpr int kMaxMissRegisters = 64;

/// Miss registers: one for each line under way, with the contexts that wait for it.
class MissRegisters {
 public:
  explicit MissRegisters(int count)
      : lines_(static_cast<std::size_t>(count)),
        waiters_(lines_.size()),
        free_(count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1) {}
  bool full() const { return free_ == 0; }
  bool none_in_use() const { return in_use_ == 0; }
  int in_use() const { return in_use_; }
  int most_in_use() const { return most_in_use_; }

  /// The register that waits for the line, or -1.
  int find(LineNumber line) const {
    if (in_use_ == 0) return -1;
    for (std::size_t i = 0; i < lines_.size(); ++i)
      if (lines_[i] == line + 1) return static_cast<int>(i);
    return -1;
  }
  /// Takes the free register with the lowest number.
  int allocate(LineNumber line) {
    const int number = std::countr_zero(free_);
    free_ &= free_ - 1;
    lines_[static_cast<std::size_t>(number)] = line + 1;
    if (++in_use_ > most_in_use_) most_in_use_ = in_use_;
    return number;
  }
  void wait(int number, Slot slot) { waiters_[static_cast<std::size_t>(number)].add(slot); }
  /// The line has come: frees the register and returns who waited.
  SlotSet release(int number, LineNumber& line) {
    const auto n = static_cast<std::size_t>(number);
    line = lines_[n] - 1;
    lines_[n] = 0;
    const SlotSet waiters = waiters_[n];
    waiters_[n] = {};
    free_ |= std::uint64_t{1} << number;
    --in_use_;
    return waiters;
  }

 private:
  std::vector<LineNumber> lines_;  // line + 1; 0: free
  std::vector<SlotSet> waiters_;
  std::uint64_t free_;  // bit number
  int in_use_ = 0, most_in_use_ = 0;
};

}  // namespace ctu::pipeline
