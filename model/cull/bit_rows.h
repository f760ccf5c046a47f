// Which entries of a compression LUT share a cell with a ray mask: one bit an entry (paper 3.2.2).
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/compression_lut.h"

namespace ctu::cull {

/// 64-bit words that a bit for every entry takes.
constexpr int words_of_bit_row(int entries) { return (entries + 63) / 64; }

inline bool bit_of_row(const std::uint64_t* row, std::uint32_t entry) {
  return (row[entry / 64] >> (entry % 64) & 1) != 0;
}

/// Makes bit rows from the LUT seen by cells: a row is the union, over the ray mask's cells, of the entries that hold
/// the cell.
class BitRowMaker {
 public:
  explicit BitRowMaker(const CompressionLut& lut);
  int words() const { return words_; }
  /// `row` must be zero.
  void make(const std::uint64_t* ray_mask, std::uint64_t* row) const;

 private:
  int mask_words_, words_;
  std::vector<std::uint64_t> entries_with_;  ///< [cell * words + word]
};

}  // namespace ctu::cull
