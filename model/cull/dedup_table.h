// `dedup`: many keys share a ray mask, so a key gives the number of its mask, and the number the mask; or, when object
// masks are compressed, the mask's row of the bit table (DESIGN section 4).
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/cell_locate.h"
#include "model/cull/compression_lut.h"
#include "model/cull/key_number.h"

namespace ctu::cull {

/// Ids of R_ray^6 keys in the order of key numbers; rows by id. Ids count distinct masks, so two ids may have equal bit
/// rows.
class DedupTable {
 public:
  /// `lut`: null for rows that are masks. Throws Error before any work when the table might not fit the memory.
  DedupTable(int resolution, int ray_resolution, const CompressionLut* lut);
  /// `entries`: of the LUT, 0: none.
  static void require_fits(int resolution, int ray_resolution, int entries);
  int ray_resolution() const { return ray_resolution_; }
  std::uint32_t distinct() const { return distinct_; }
  std::uint32_t id(std::uint32_t key_number) const { return ids_[key_number]; }
  const std::vector<std::uint32_t>& ids() const { return ids_; }
  /// R^3 bits, or a bit for every entry.
  const std::uint64_t* row(std::uint32_t id) const {
    return rows_.data() + static_cast<std::size_t>(id) * static_cast<std::size_t>(row_words_);
  }

 private:
  int ray_resolution_, row_words_;
  std::uint32_t distinct_ = 0;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint64_t> rows_;
};

}  // namespace ctu::cull
