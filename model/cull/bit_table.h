// `bit-table`: key x entry of the compression LUT -> do their masks share a cell? (paper 3.2.2)
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/cell_locate.h"
#include "model/cull/compression_lut.h"
#include "model/cull/key_number.h"

namespace ctu::cull {

/// R_ray^6 rows in the order of key numbers, a bit for every entry in each.
class BitTable {
 public:
  /// Throws Error before any work when the rows do not fit the memory.
  BitTable(const CompressionLut& lut, int ray_resolution);
  static void require_fits(int ray_resolution, int entries);
  int ray_resolution() const { return ray_resolution_; }
  int entries() const { return entries_; }
  std::uint32_t rows() const { return key_count(ray_resolution_); }
  const std::uint64_t* row(std::uint32_t number) const {
    return bits_.data() + static_cast<std::size_t>(number) * static_cast<std::size_t>(words_);
  }

 private:
  int ray_resolution_, entries_, words_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace ctu::cull
