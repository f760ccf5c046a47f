// Rows by separating axes, in exact integers: the swept ray cell overlaps a mask cell iff the begin cell's corner, on
// its way, lies strictly inside the mask cell grown by the ray cell; in two dimensions a segment and an open rectangle
// are apart iff one of the two sides' normals or the segment's own normal separates them.
#include "model/cull/projection_table.h"

#include <cstdlib>
#include <numeric>

#include "model/cull/cell_bits.h"

namespace ctu::cull {
namespace {

/// Corner of the moving cell from `from` to `to`, against mask cell [low, low + a) on one axis, in doubled units:
/// the middle of the way relative to the middle of the grown cell, and both half extents.
struct AxisView {
  int middle, half_way, half_cell;
};

AxisView view(int begin, int end, int cell, int ray_width, int mask_width) {
  const int from = begin * ray_width, to = end * ray_width;
  const int low = cell * mask_width - ray_width, high = (cell + 1) * mask_width;
  return {from + to - (low + high), to - from, high - low};
}

bool overlaps(const AxisView& a, const AxisView& b) {
  if (std::abs(a.middle) >= std::abs(a.half_way) + a.half_cell) return false;
  if (std::abs(b.middle) >= std::abs(b.half_way) + b.half_cell) return false;
  if (a.half_way == 0 && b.half_way == 0) return true;
  const int distance = std::abs(a.middle * b.half_way - b.middle * a.half_way);
  return distance < a.half_cell * std::abs(b.half_way) + b.half_cell * std::abs(a.half_way);
}

template <int R>
void and_rows(std::uint64_t xy, std::uint64_t yz, std::uint64_t xz, std::uint64_t* words) {
  const MaskWords<R> mask = and_of_projections<R>(xy, yz, xz);
  for (int w = 0; w < kWords<R>; ++w) words[w] = mask[w];
}

}  // namespace

ProjectionTable::ProjectionTable(int resolution, int ray_resolution)
    : resolution_(resolution), ray_resolution_(ray_resolution) {
  validate({.resolution = resolution, .ray_resolution = ray_resolution});
  const int n = ray_resolution, units = std::lcm(resolution, n);
  const int ray_width = units / n, mask_width = units / resolution;
  rows_ = static_cast<std::uint32_t>(n * n * n * n);
  bits_.reserve(rows_);
  for (int end_b = 0; end_b < n; ++end_b)
    for (int end_a = 0; end_a < n; ++end_a)
      for (int begin_b = 0; begin_b < n; ++begin_b)
        for (int begin_a = 0; begin_a < n; ++begin_a) {
          std::uint64_t row = 0;
          for (int j = 0; j < resolution; ++j) {
            const AxisView b = view(begin_b, end_b, j, ray_width, mask_width);
            for (int i = 0; i < resolution; ++i)
              if (overlaps(view(begin_a, end_a, i, ray_width, mask_width), b))
                row |= std::uint64_t{1} << (i + resolution * j);
          }
          bits_.push_back(row);
        }
}

std::uint32_t ProjectionTable::row_index(CellKey key, AxisPair pair) const {
  const int a = pair == AxisPair::YZ ? 1 : 0, b = pair == AxisPair::XY ? 1 : 2;
  const int n = ray_resolution_;
  return static_cast<std::uint32_t>(key.begin(a) + n * (key.begin(b) + n * (key.end(a) + n * key.end(b))));
}

void ProjectionTable::ray_mask(CellKey key, std::uint64_t* words) const {
  const std::uint64_t xy = row(row_index(key, AxisPair::XY)), yz = row(row_index(key, AxisPair::YZ)),
                      xz = row(row_index(key, AxisPair::XZ));
  with_resolution(resolution_, [&](auto r) { and_rows<r()>(xy, yz, xz, words); });
}

}  // namespace ctu::cull
