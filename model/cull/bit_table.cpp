#include "model/cull/bit_table.h"

#include <string>

#include "model/cull/bit_rows.h"
#include "model/cull/projection_table.h"
#include "model/cull/table_limit.h"

namespace ctu::cull {
void BitTable::require_fits(int ray_resolution, int entries) {
  require_table_fits("bit table", ray_resolution, "R_ray^6 rows of " + std::to_string(entries) + " bits",
                     8 * std::uint64_t{key_count(ray_resolution)} * static_cast<unsigned>(words_of_bit_row(entries)),
                     "choose a smaller R_ray or fewer entries, or the design `projection`, which reads R_ray^4 rows");
}

BitTable::BitTable(const CompressionLut& lut, int ray_resolution)
    : ray_resolution_(ray_resolution), entries_(lut.entries()), words_(words_of_bit_row(lut.entries())) {
  require_fits(ray_resolution, lut.entries());
  bits_.resize(static_cast<std::size_t>(rows()) * static_cast<std::size_t>(words_));
  const ProjectionTable ray_masks(lut.resolution(), ray_resolution);
  const BitRowMaker bit_rows(lut);
  std::vector<std::uint64_t> ray_mask(static_cast<std::size_t>(lut.words()));
  std::uint64_t* row = bits_.data();
  for (std::uint32_t number = 0; number < rows(); ++number, row += words_) {
    ray_masks.ray_mask(numbered_key(number, ray_resolution), ray_mask.data());
    bit_rows.make(ray_mask.data(), row);
  }
}

}  // namespace ctu::cull
