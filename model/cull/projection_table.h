// `projection`: one 2-D sweep table of R_ray^4 rows of R^2 bits, read three times (xy, yz, xz); the AND of the three
// expanded rows is the ray mask of RayMaskTable, bit for bit (DESIGN section 4).
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/cell_locate.h"
#include "model/cull/options.h"

namespace ctu::cull {

/// The pair of axes a 2-D table is read for; the table's content is the same for all three.
enum class AxisPair : std::uint8_t { XY, YZ, XZ };

/// Row order: begin of the first axis fastest, begin second, end first, end second. Bit i + R*j: cell i of the first
/// axis, j of the second.
class ProjectionTable {
 public:
  ProjectionTable(int resolution, int ray_resolution);
  int resolution() const { return resolution_; }
  int ray_resolution() const { return ray_resolution_; }
  std::uint32_t rows() const { return rows_; }
  std::uint32_t row_index(CellKey key, AxisPair pair) const;
  std::uint64_t row(std::uint32_t index) const { return bits_[index]; }  ///< R^2 <= 64 bits

  /// The ray mask: AND of the three rows, each expanded along the axis it does not see.
  void ray_mask(CellKey key, std::uint64_t* words) const;

 private:
  int resolution_, ray_resolution_;
  std::uint32_t rows_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace ctu::cull
