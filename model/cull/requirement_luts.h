// Requirement LUTs (paper 3.2.3): which entries of a compression LUT hold a given pattern of b bits, so that the
// tightest entry for a mask is found by a few look-ups and ANDs instead of a walk over the entries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/cull/compression_lut.h"

namespace ctu::cull {

inline constexpr int kMaxChunkBits = 16;

/// For each chunk of b mask bits and each of its 2^b patterns the list of entries that hold it: a bit sequence with bit
/// e for entry e, which are in ascending order of set bits.
class RequirementLuts {
 public:
  /// Keeps nothing of `lut` itself. Throws Error when `chunk_bits` (b) is not 1 .. kMaxChunkBits.
  explicit RequirementLuts(const CompressionLut& lut, int chunk_bits = 8);

  /// Algorithm 3: the same entry as lut.tightest(mask), for any mask of the LUT's resolution.
  int find(const std::uint64_t* mask) const { return find(mask, 0); }

  /// The tightest entry among those from number `first` on.
  int find(const std::uint64_t* mask, int first) const;

  int chunk_bits() const { return chunk_bits_; }
  int chunks() const { return static_cast<int>(places_.size()); }
  /// Memory of all lists.
  std::uint64_t bytes() const { return lists_.size() * sizeof(lists_[0]); }

 private:
  /// Lists are ANDed a block at a time, so that the compiler has a vector to work with.
  static constexpr std::size_t kBlockWords = 4;

  /// Where a chunk lies in a mask.
  struct Place {
    std::uint32_t word, shift;
    bool straddles;  ///< goes on in the next word
  };

  std::uint64_t* list(std::size_t chunk, std::uint64_t pattern) {
    return lists_.data() + ((chunk << chunk_bits_) + pattern) * list_words_;
  }
  void fill(const CompressionLut& lut, std::size_t chunk);
  std::uint64_t pattern(const std::uint64_t* mask, const Place& place) const {
    std::uint64_t bits = mask[place.word] >> place.shift;
    if (place.straddles) bits |= mask[place.word + 1] << (64 - place.shift);
    return bits & ((std::uint64_t{1} << chunk_bits_) - 1);
  }

  int chunk_bits_;
  std::size_t list_words_;  ///< of one list, a multiple of kBlockWords
  std::vector<Place> places_;
  std::vector<std::uint64_t> lists_;  ///< [chunk][pattern][word]
};

}  // namespace ctu::cull
