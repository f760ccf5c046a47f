#include "model/cull/mask_numbering.h"

#include <algorithm>

namespace ctu::cull {

std::size_t MaskNumbering::slot_of(const std::uint64_t* mask) const {
  std::uint64_t hash = 0;
  for (int w = 0; w < words_; ++w) {
    hash = (hash ^ mask[w]) * 0x9E3779B97F4A7C15u;  // 2^64 over the golden ratio
    hash ^= hash >> 32;
  }
  const std::size_t last = slots_.size() - 1;
  std::size_t slot = static_cast<std::size_t>(hash) & last;
  const auto words = static_cast<std::size_t>(words_);
  while (slots_[slot] != kFree && !std::equal(mask, mask + words, masks_.data() + slots_[slot] * words))
    slot = (slot + 1) & last;
  return slot;
}

std::uint32_t MaskNumbering::number_of(const std::uint64_t* mask) {
  std::size_t slot = slot_of(mask);
  if (slots_[slot] != kFree) return slots_[slot];
  if (2 * (static_cast<std::size_t>(count_) + 1) > slots_.size()) {
    grow();
    slot = slot_of(mask);
  }
  masks_.insert(masks_.end(), mask, mask + words_);
  slots_[slot] = count_;
  return count_++;
}

void MaskNumbering::grow() {
  slots_.assign(2 * slots_.size(), kFree);
  for (std::uint32_t number = 0; number < count_; ++number)
    slots_[slot_of(masks_.data() + static_cast<std::size_t>(number) * static_cast<std::size_t>(words_))] = number;
}

}  // namespace ctu::cull
