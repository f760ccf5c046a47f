#include "model/cull/compression_lut.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>

#include "model/base/error.h"
#include "model/cull/mask_words.h"

namespace ctu::cull {

CompressionLut::CompressionLut(int resolution, const std::vector<std::uint64_t>& masks)
    : resolution_(resolution), words_(words_per_mask(resolution)) {
  const auto words = static_cast<std::size_t>(words_);
  std::vector<std::uint64_t> pool = masks;
  const std::vector<std::uint64_t> full = full_mask(resolution);
  pool.insert(pool.end(), full.begin(), full.end());

  std::vector<std::size_t> order(pool.size() / words);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto mask = [&](std::size_t i) { return pool.data() + i * words; };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const int bits_a = count_bits(mask(a), words_), bits_b = count_bits(mask(b), words_);
    if (bits_a != bits_b) return bits_a < bits_b;
    return std::lexicographical_compare(mask(a), mask(a) + words, mask(b), mask(b) + words);
  });
  for (const std::size_t i : order) {
    if (!bits_.empty() && std::equal(mask(i), mask(i) + words, bits_.end() - static_cast<std::ptrdiff_t>(words)))
      continue;
    bits_.insert(bits_.end(), mask(i), mask(i) + words);
    set_bits_.push_back(count_bits(mask(i), words_));
  }
  if (entries() > kMaxEntries)
    throw Error("compression LUT", "has " + std::to_string(entries()) + " entries, the full mask included",
                "choose at most " + std::to_string(kMaxEntries));
}

int CompressionLut::index_bits() const {
  return std::max(1, static_cast<int>(std::bit_width(static_cast<unsigned>(entries() - 1))));
}

int CompressionLut::tightest(const std::uint64_t* mask) const {
  int index = 0;
  while (!holds_all(entry(index), mask, words_)) ++index;  // ends at the full mask
  return index;
}

}  // namespace ctu::cull
