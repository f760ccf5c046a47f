#include "model/cull/bit_rows.h"

#include <bit>

namespace ctu::cull {

BitRowMaker::BitRowMaker(const CompressionLut& lut)
    : mask_words_(lut.words()),
      words_(words_of_bit_row(lut.entries())),
      entries_with_(static_cast<std::size_t>(64 * mask_words_) * static_cast<std::size_t>(words_)) {
  for (int entry = 0; entry < lut.entries(); ++entry)
    for (int cell = 0; cell < 64 * mask_words_; ++cell)
      if (bit_of_row(lut.entry(entry), static_cast<std::uint32_t>(cell)))
        entries_with_[static_cast<std::size_t>(cell * words_ + entry / 64)] |= std::uint64_t{1} << (entry % 64);
}

void BitRowMaker::make(const std::uint64_t* ray_mask, std::uint64_t* row) const {
  for (int w = 0; w < mask_words_; ++w)
    for (std::uint64_t cells = ray_mask[w]; cells != 0; cells &= cells - 1) {
      const std::uint64_t* entries =
          entries_with_.data() + static_cast<std::size_t>(words_ * (64 * w + std::countr_zero(cells)));
      for (int i = 0; i < words_; ++i) row[i] |= entries[i];
    }
}

}  // namespace ctu::cull
