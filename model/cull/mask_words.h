// Masks as runs of 64-bit words whose number is known at run time only; cell_bits.h has the forms for inner loops.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/cull/options.h"

namespace ctu::cull {

inline int count_bits(const std::uint64_t* mask, int words) {
  int count = 0;
  for (int w = 0; w < words; ++w) count += std::popcount(mask[w]);
  return count;
}

/// Whether `outer` holds every bit of `inner`.
inline bool holds_all(const std::uint64_t* outer, const std::uint64_t* inner, int words) {
  std::uint64_t missing = 0;
  for (int w = 0; w < words; ++w) missing |= inner[w] & ~outer[w];
  return missing == 0;
}

/// The mask of R^3 set bits.
inline std::vector<std::uint64_t> full_mask(int resolution) {
  const int bits = resolution * resolution * resolution;
  std::vector<std::uint64_t> words(static_cast<std::size_t>(words_per_mask(resolution)), ~std::uint64_t{0});
  if (bits % 64 != 0) words.back() = (std::uint64_t{1} << (bits % 64)) - 1;
  return words;
}

}  // namespace ctu::cull
