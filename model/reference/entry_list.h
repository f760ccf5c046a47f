// Where the rays of a packet go on alone: a few nodes of the tree, nearest first.
#pragma once

#include <array>
#include <cassert>

#include "model/accel/child_ref.h"

namespace ctu::reference {

/// A node that rays go on from, and a t that is not after any ray's first meeting with what lies below it.
struct Entry {
  accel::ChildRef ref = 0;
  float t0 = 0;
  bool operator==(const Entry&) const = default;
};

inline constexpr int kMostEntries = 16;

/// Kept by t0; of equal ones the one added first comes first.
class EntryList {
 public:
  int count() const { return count_; }
  const Entry& operator[](int i) const { return entries_[static_cast<std::size_t>(i)]; }
  void clear() { count_ = 0; }
  void add(const Entry& entry) {
    assert(count_ < kMostEntries);
    auto place = static_cast<std::size_t>(count_++);
    for (; place > 0 && entry.t0 < entries_[place - 1].t0; --place) entries_[place] = entries_[place - 1];
    entries_[place] = entry;
  }

 private:
  std::array<Entry, kMostEntries> entries_;
  int count_ = 0;
};

}  // namespace ctu::reference
