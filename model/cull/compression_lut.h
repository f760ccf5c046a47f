// The compression LUT (paper 3.2.2): a few masks, of which every object mask is replaced by the tightest that holds it,
// so that a node stores an index instead of a mask.
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/options.h"

namespace ctu::cull {

/// Masks of R^3 bits in ascending order of set bits (then of their words), without repetition; the last one is full, so
/// every mask has an entry that holds it.
class CompressionLut {
 public:
  /// `masks`: words_per_mask(resolution) words each, in any order; the full mask is added when it is not there. Throws
  /// Error when that makes more than kMaxEntries.
  CompressionLut(int resolution, const std::vector<std::uint64_t>& masks);

  int resolution() const { return resolution_; }
  int words() const { return words_; }
  int entries() const { return static_cast<int>(set_bits_.size()); }
  /// Bits of an index, at least 1.
  int index_bits() const;
  const std::uint64_t* entry(int index) const {
    return bits_.data() + static_cast<std::size_t>(index) * static_cast<std::size_t>(words_);
  }
  int set_bits(int index) const { return set_bits_[static_cast<std::size_t>(index)]; }
  /// All entries, one behind the other.
  const std::vector<std::uint64_t>& bits() const { return bits_; }

  /// The first entry, hence one with the fewest set bits, that holds every bit of `mask`: the paper's brute-force
  /// search, which requirement_luts.h answers faster.
  int tightest(const std::uint64_t* mask) const;

 private:
  int resolution_, words_;
  std::vector<std::uint64_t> bits_;
  std::vector<int> set_bits_;
};

}  // namespace ctu::cull
