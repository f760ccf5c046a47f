#include "model/cull/distinct_masks.h"

#include <algorithm>
#include <bit>

namespace ctu::cull {
namespace {

std::uint64_t hash_of(const std::uint64_t* mask, std::size_t words) {
  std::uint64_t hash = 0;
  for (std::size_t w = 0; w < words; ++w) {
    hash = (hash ^ mask[w]) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 32;
  }
  return hash;
}

/// Numbers of masks by their bits: open addressing, less than half full.
class MaskNumbers {
 public:
  explicit MaskNumbers(DistinctMasks& masks) : masks_(masks), slots_(1024) {}

  /// The mask's number; a new one when it was not there.
  std::size_t number_of(const std::uint64_t* mask) {
    const auto words = static_cast<std::size_t>(masks_.words);
    std::size_t slot = find(mask);
    if (slots_[slot] == 0) {
      if (2 * (masks_.size() + 1) > slots_.size()) {
        grow();
        slot = find(mask);
      }
      masks_.bits.insert(masks_.bits.end(), mask, mask + words);
      masks_.sum.push_back(0);
      masks_.largest.push_back(0);
      slots_[slot] = static_cast<std::uint32_t>(masks_.size());
    }
    return slots_[slot] - 1;
  }

 private:
  /// Where the mask is, or where it would go.
  std::size_t find(const std::uint64_t* mask) const {
    const auto words = static_cast<std::size_t>(masks_.words);
    std::size_t slot = hash_of(mask, words) & (slots_.size() - 1);
    while (slots_[slot] != 0 && !std::equal(mask, mask + words, masks_.mask(slots_[slot] - 1)))
      slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  void grow() {
    slots_.assign(4 * slots_.size(), 0);
    for (std::size_t i = 0; i < masks_.size(); ++i) slots_[find(masks_.mask(i))] = static_cast<std::uint32_t>(i + 1);
  }

  DistinctMasks& masks_;
  std::vector<std::uint32_t> slots_;  ///< number + 1; 0: free. Their number is a power of two.
};

}  // namespace

DistinctMasks distinct_masks(const ObjectMasks& masks, const std::vector<double>& weights) {
  DistinctMasks distinct;
  distinct.words = masks.words;
  MaskNumbers numbers(distinct);
  for (std::size_t child = 0; child < weights.size(); ++child) {
    if (!(weights[child] > 0)) continue;
    const std::size_t i = numbers.number_of(masks.bits.data() + child * static_cast<std::size_t>(masks.words));
    distinct.sum[i] += weights[child];
    distinct.largest[i] = std::max(distinct.largest[i], weights[child]);
  }
  return distinct;
}

}  // namespace ctu::cull
