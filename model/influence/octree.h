// Which influence areas contain a point: a lookup of a few steps instead of a test of each area. A cell is divided
// until the areas that touch it all contain it, or for a number of levels; so a leaf may name an area that does not
// contain the point, and never leaves one out that does.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/influence/area.h"

namespace ctu::influence {

inline constexpr int kOctreeLevels = 5;  ///< the paper's 4 to 6

class AreaOctree {
 public:
  AreaOctree() = default;
  /// Over the box `lower`..`upper`, at most `levels` divisions deep.
  AreaOctree(std::span<const PreparedArea> areas, const Vec3& lower, const Vec3& upper, int levels = kOctreeLevels);

  /// The areas, by their positions in ascending order, that may contain the point: all of them outside the box. The
  /// point has no NaN.
  std::span<const std::uint32_t> at(const Vec3& point) const;

  std::size_t cells() const { return cells_.size(); }

 private:
  struct Cell {
    std::uint32_t first_child = 0;       ///< of eight in a row; 0: a leaf
    std::uint32_t first = 0, count = 0;  ///< a leaf's areas in list_
  };
  void divide(std::uint32_t cell, std::span<const PreparedArea> areas, std::span<const std::uint32_t> touching,
              const Vec3& lower, const Vec3& upper, int levels);

  Vec3 lower_, upper_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> list_, all_;
};

}  // namespace ctu::influence
