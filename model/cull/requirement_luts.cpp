#include "model/cull/requirement_luts.h"

#include <bit>
#include <string>

#include "model/base/error.h"

namespace ctu::cull {

RequirementLuts::RequirementLuts(const CompressionLut& lut, int chunk_bits) : chunk_bits_(chunk_bits) {
  if (chunk_bits < 1 || chunk_bits > kMaxChunkBits)
    throw Error("requirement LUTs", "have chunks of " + std::to_string(chunk_bits) + " bits",
                "choose 1 to " + std::to_string(kMaxChunkBits));
  const int mask_bits = lut.resolution() * lut.resolution() * lut.resolution();
  for (int bit = 0; bit < mask_bits; bit += chunk_bits) {
    const auto word = static_cast<std::uint32_t>(bit / 64), shift = static_cast<std::uint32_t>(bit % 64);
    places_.push_back({word, shift, bit % 64 + chunk_bits > 64 && bit / 64 + 1 < lut.words()});
  }
  constexpr std::size_t kBlockBits = 64 * kBlockWords;
  list_words_ = (static_cast<std::size_t>(lut.entries()) + kBlockBits - 1) / kBlockBits * kBlockWords;
  lists_.resize((places_.size() << chunk_bits) * list_words_);
  for (std::size_t chunk = 0; chunk < places_.size(); ++chunk) fill(lut, chunk);
}

/// A pattern's list is that of the pattern without its lowest bit, ANDed with that of the lowest bit alone.
void RequirementLuts::fill(const CompressionLut& lut, std::size_t chunk) {
  for (int e = 0; e < lut.entries(); ++e) {
    const std::uint64_t entry_bit = std::uint64_t{1} << (e % 64);
    const auto word = static_cast<std::size_t>(e / 64);
    list(chunk, 0)[word] |= entry_bit;
    for (std::uint64_t held = pattern(lut.entry(e), places_[chunk]); held != 0; held &= held - 1)
      list(chunk, held & (~held + 1))[word] |= entry_bit;
  }
  for (std::uint64_t p = 1; p < std::uint64_t{1} << chunk_bits_; ++p) {
    const std::uint64_t lowest = p & (~p + 1);
    if (p == lowest) continue;
    for (std::size_t w = 0; w < list_words_; ++w)
      list(chunk, p)[w] = list(chunk, p ^ lowest)[w] & list(chunk, lowest)[w];
  }
}

int RequirementLuts::find(const std::uint64_t* mask, int first) const {
  constexpr int kBlockBits = 64 * kBlockWords;
  for (int block = first / kBlockBits;; ++block) {  // ends at the full mask, which is in every list
    std::uint64_t both[kBlockWords] = {~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}};
    const std::uint64_t* lists = lists_.data() + static_cast<std::size_t>(block) * kBlockWords;
    for (const Place& place : places_) {
      const std::uint64_t* list = lists + pattern(mask, place) * list_words_;
      for (std::size_t w = 0; w < kBlockWords; ++w) both[w] &= list[w];
      lists += list_words_ << chunk_bits_;
    }
    for (int w = 0; w < static_cast<int>(kBlockWords); ++w) {
      const int entry = block * kBlockBits + 64 * w;
      if (entry + 64 <= first) continue;
      if (entry < first) both[w] = both[w] >> (first - entry) << (first - entry);
      if (both[w] != 0) return entry + std::countr_zero(both[w]);
    }
  }
}

}  // namespace ctu::cull
