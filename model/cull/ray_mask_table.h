// `mask-lut`: the ray mask of every pair of begin and end cells, by exact sweep (paper 3.1.1).
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/cell_locate.h"
#include "model/cull/key_number.h"
#include "model/cull/options.h"

namespace ctu::cull {

/// R_ray^6 rows of R^3 bits, in the order of key numbers: begin x fastest, then begin y, z, end x, y, z.
class RayMaskTable {
 public:
  /// Throws Error, before any work, when R or R_ray is out of range or the rows do not fit the memory.
  RayMaskTable(int resolution, int ray_resolution);
  static void require_fits(int resolution, int ray_resolution);
  int resolution() const { return resolution_; }
  int ray_resolution() const { return ray_resolution_; }
  int words() const { return words_; }
  std::uint32_t rows() const { return rows_; }
  std::uint32_t row_index(CellKey key) const { return key_number(key, ray_resolution_); }
  const std::uint64_t* row(std::uint32_t index) const {
    return bits_.data() + static_cast<std::size_t>(index) * words_;
  }

 private:
  int resolution_, ray_resolution_, words_;
  std::uint32_t rows_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace ctu::cull
