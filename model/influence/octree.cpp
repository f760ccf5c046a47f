#include "model/influence/octree.h"

#include <algorithm>
#include <numeric>

namespace ctu::influence {
namespace {

/// Where a cell is cut. Looking up and dividing agree on it to the bit; it does not overflow.
float middle(float lower, float upper) { return 0.5f * lower + 0.5f * upper; }

}  // namespace

AreaOctree::AreaOctree(std::span<const PreparedArea> areas, const Vec3& lower, const Vec3& upper, int levels)
    : lower_(lower), upper_(upper), cells_(1), all_(areas.size()) {
  std::iota(all_.begin(), all_.end(), 0u);
  divide(0, areas, all_, lower, upper, levels);
}

void AreaOctree::divide(std::uint32_t cell, std::span<const PreparedArea> areas, std::span<const std::uint32_t> above,
                        const Vec3& lower, const Vec3& upper, int levels) {
  std::vector<std::uint32_t> touching;
  bool uniform = true;
  for (const std::uint32_t i : above) {
    if (!areas[i].may_touch(lower, upper)) continue;
    touching.push_back(i);
    uniform = uniform && areas[i].certainly_contains(lower, upper);
  }
  if (uniform || levels == 0) {
    cells_[cell].first = static_cast<std::uint32_t>(list_.size());
    cells_[cell].count = static_cast<std::uint32_t>(touching.size());
    list_.insert(list_.end(), touching.begin(), touching.end());
    return;
  }
  const auto first = static_cast<std::uint32_t>(cells_.size());
  cells_[cell].first_child = first;
  cells_.resize(cells_.size() + 8);
  for (std::uint32_t child = 0; child < 8; ++child) {
    Vec3 from = lower, to = upper;
    for (int axis = 0; axis < 3; ++axis)
      (((child >> axis) & 1) != 0 ? from : to)[axis] = middle(lower[axis], upper[axis]);
    divide(first + child, areas, touching, from, to, levels - 1);
  }
}

std::span<const std::uint32_t> AreaOctree::at(const Vec3& point) const {
  for (int axis = 0; axis < 3; ++axis)
    if (point[axis] < lower_[axis] || point[axis] > upper_[axis]) return all_;
  if (cells_.empty()) return all_;
  Vec3 lower = lower_, upper = upper_;
  std::uint32_t cell = 0;
  while (cells_[cell].first_child != 0) {
    std::uint32_t child = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float cut = middle(lower[axis], upper[axis]);
      const bool high = point[axis] >= cut;
      (high ? lower : upper)[axis] = cut;
      if (high) child |= 1u << axis;
    }
    cell = cells_[cell].first_child + child;
  }
  return {list_.data() + cells_[cell].first, cells_[cell].count};
}

}  // namespace ctu::influence
