// A set of contexts as one bit each, with the round-robin choice that hardware makes of it.
#pragma once

#include <bit>
#include <cstdint>

#include "model/pipeline/tokens.h"

namespace ctu::pipeline {

inline constexpr int kMaxContexts = 256;

class SlotSet {
 public:
  bool empty() const { return count_ == 0; }
  int count() const { return count_; }
  bool contains(int slot) const { return ((words_[slot >> 6] >> (slot & 63)) & 1u) != 0; }
  void add(int slot) {
    words_[slot >> 6] |= std::uint64_t{1} << (slot & 63);
    ++count_;
  }
  void remove(int slot) {
    words_[slot >> 6] &= ~(std::uint64_t{1} << (slot & 63));
    --count_;
  }
  /// The first member at or after `start`, going round. The set must not be empty.
  int next_from(int start) const {
    int word = (start >> 6) & 3;
    std::uint64_t rest = words_[word] & (~std::uint64_t{0} << (start & 63));
    while (rest == 0) {
      word = (word + 1) & 3;
      rest = words_[word];
    }
    return word * 64 + std::countr_zero(rest);
  }
  /// Calls `visit(slot)` for every member in ascending order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (int word = 0; word < kMaxContexts / 64; ++word)
      for (std::uint64_t rest = words_[word]; rest != 0; rest &= rest - 1) visit(word * 64 + std::countr_zero(rest));
  }

 private:
  std::uint64_t words_[kMaxContexts / 64] = {};
  int count_ = 0;
};

/// The first member of `a` or `b` at or after `start`, going round, or -1 when both are empty.
inline int next_of_either(const SlotSet* a, const SlotSet* b, int start) {
  const int in_a = a != nullptr && !a->empty() ? a->next_from(start) : -1;
  const int in_b = b != nullptr && !b->empty() ? b->next_from(start) : -1;
  if (in_a < 0 || in_b < 0) return in_a < 0 ? in_b : in_a;
  const int from_a = (in_a - start) & (kMaxContexts - 1), from_b = (in_b - start) & (kMaxContexts - 1);
  return from_a <= from_b ? in_a : in_b;
}

}  // namespace ctu::pipeline
