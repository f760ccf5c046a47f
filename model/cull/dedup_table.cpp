#include "model/cull/dedup_table.h"

#include <string>

#include "model/cull/bit_rows.h"
#include "model/cull/mask_numbering.h"
#include "model/cull/projection_table.h"
#include "model/cull/table_limit.h"

namespace ctu::cull {
void DedupTable::require_fits(int resolution, int ray_resolution, int entries) {
  // Ids, and the most masks and bit rows that there can be: a key and its reverse share theirs.
  const std::uint64_t keys = key_count(ray_resolution);
  const auto cells = static_cast<std::uint64_t>(ray_resolution * ray_resolution * ray_resolution);
  const int row_words = words_per_mask(resolution) + words_of_bit_row(entries);
  require_table_fits("deduplicated ray masks", ray_resolution,
                     "R_ray^6 numbers and up to half as many masks of R = " + std::to_string(resolution),
                     4 * keys + 8 * static_cast<std::uint64_t>(row_words) * ((keys + cells) / 2),
                     "choose a smaller R_ray, or the design `projection`, which reads R_ray^4 rows");
}

DedupTable::DedupTable(int resolution, int ray_resolution, const CompressionLut* lut)
    : ray_resolution_(ray_resolution), row_words_(words_per_mask(resolution)) {
  require_fits(resolution, ray_resolution, lut == nullptr ? 0 : lut->entries());
  ids_.resize(key_count(ray_resolution));
  const ProjectionTable ray_masks(resolution, ray_resolution);
  MaskNumbering numbering(row_words_);
  std::vector<std::uint64_t> mask(static_cast<std::size_t>(row_words_));
  const auto cells = static_cast<std::uint32_t>(ray_resolution * ray_resolution * ray_resolution);
  for (std::uint32_t end = 0; end < cells; ++end)
    for (std::uint32_t begin = 0; begin <= end; ++begin) {
      const std::uint32_t number = begin + cells * end;
      ray_masks.ray_mask(numbered_key(number, ray_resolution), mask.data());
      ids_[number] = ids_[end + cells * begin] = numbering.number_of(mask.data());
    }
  distinct_ = numbering.count();
  if (lut == nullptr) {
    rows_ = numbering.masks();
    return;
  }
  const BitRowMaker bit_rows(*lut);
  row_words_ = bit_rows.words();
  rows_.resize(static_cast<std::size_t>(distinct_) * static_cast<std::size_t>(row_words_));
  for (std::uint32_t id = 0; id < distinct_; ++id)
    bit_rows.make(numbering.masks().data() + static_cast<std::size_t>(id) * mask.size(),
                  rows_.data() + static_cast<std::size_t>(id) * static_cast<std::size_t>(row_words_));
}

}  // namespace ctu::cull
