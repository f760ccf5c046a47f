// Algorithm 2: the cells of a box that the occupied cells of a box below it fill.
//
// An occupied cell stands for whatever lies in it. Geometry on a border between two cells has set both, so a cell may
// count as half-open towards its upper neighbour, except at the faces of its box. Which side of an ancestor's border
// a child's border lies on is decided exactly: boxes share faces all the time, and an error margin there would
// dilate every mask by a layer (as the algorithm as printed does). The result holds every closed cell
// that the geometry touches.
#pragma once

#include <cmath>

#include "model/cull/triangle_cells.h"

namespace ctu::cull {

/// Sign of the exact sum of four binary64 numbers, by growing an expansion (Shewchuk 1997, section 2.4).
inline int sign_of_sum(const double (&terms)[4]) {
  double expansion[4] = {};
  for (int n = 0; n < 4; ++n) {
    double sum = terms[n];
    for (int i = 0; i < n; ++i) {
      const double total = sum + expansion[i], part = total - sum;
      expansion[i] = (sum - (total - part)) + (expansion[i] - part);
      sum = total;
    }
    expansion[n] = sum;
  }
  for (int i = 3; i >= 0; --i)
    if (expansion[i] != 0) return expansion[i] > 0 ? 1 : -1;
  return 0;
}

namespace detail {

/// Where a border of the child lies among the R - 1 inner borders of the ancestor, on one axis.
struct BorderPlace {
  int below;        ///< inner borders strictly below it: the closed cell under it
  int at_or_below;  ///< its floor cell
};

/// `near` is the child's border in the ancestor's grid coordinates, from 0 to R, to within 2^-46: both its faces'
/// coordinates are off by at most R 2^-51, and the sum has no cancellation.
template <int R>
BorderPlace place_border(double near, int x, float child_lo, float child_hi, float lo, float hi) {
  const int j = static_cast<int>(near + 0.5);
  if (std::fabs(near - j) > 0x1p-45) {
    const int floor = std::min(static_cast<int>(near), R - 1);
    return {floor, floor};
  }
  if (j <= 0) return {0, 0};
  if (j >= R) return {R - 1, R - 1};
  const int side = sign_of_sum({static_cast<double>(R - x) * child_lo, static_cast<double>(x) * child_hi,
                                -static_cast<double>(R - j) * lo, -static_cast<double>(j) * hi});
  return {side > 0 ? j : j - 1, side >= 0 ? j : j - 1};
}

/// For each cell of the child on one axis, the ancestor's cells that it fills.
template <int R>
struct AxisFill {
  int first[R], last[R];
};

/// `near[x]`: where the child's border x lies in the ancestor's grid coordinates.
template <int R>
AxisFill<R> make_axis_fill(const BoxGrid<R>& grid, const Bounds& box, const Bounds& child, const Axes (&near)[R + 1],
                           int axis) {
  AxisFill<R> fill;
  const float lo = box.lower[axis], hi = box.upper[axis], child_lo = child.lower[axis], child_hi = child.upper[axis];
  const bool same = lo == child_lo && hi == child_hi, flat = (grid.flat_axes >> axis & 1) != 0;
  if (same || flat) {
    for (int x = 0; x < R; ++x) {
      fill.first[x] = flat ? 0 : x;
      fill.last[x] = flat ? R - 1 : x;
    }
    return fill;
  }
  for (int x = 0; x <= R; ++x) {
    const BorderPlace place = place_border<R>(near[x][axis], x, child_lo, child_hi, lo, hi);
    if (x < R) fill.first[x] = x == 0 ? place.below : place.at_or_below;
    if (x > 0) fill.last[x - 1] = x == R ? place.at_or_below : place.below;
  }
  for (int x = 0; x < R; ++x) fill.last[x] = std::max(fill.first[x], fill.last[x]);  // a flat child's borders coincide
  return fill;
}

/// Where the child's borders lie in the ancestor's grid coordinates, from 0 to R.
template <int R>
void place_borders(const BoxGrid<R>& grid, const Bounds& child, Axes (&near)[R + 1]) {
  constexpr double kMost = R;
  Axes from, to;
  grid.to_grid(child.lower, from);
  grid.to_grid(child.upper, to);
  for (int x = 0; x <= R; ++x) {
    const Axes at = ((R - x) * from + x * to) / kMost;
    near[x] = at > 0 ? (at < kMost ? at : Axes{} + kMost) : Axes{};
  }
}

/// For any set of a row's cells, what they fill of the ancestor's row: looked up by four cells at a time.
template <int R>
class RowFill {
 public:
  explicit RowFill(const AxisFill<R>& x) {
    for (unsigned set = 1; set < 16; ++set) {
      const int cell = std::countr_zero(set);
      low_[set] = low_[set & (set - 1)] | (cell < R ? row_bits(x, cell) : 0);
      if constexpr (R > 4) high_[set] = high_[set & (set - 1)] | (4 + cell < R ? row_bits(x, 4 + cell) : 0);
    }
  }
  std::uint64_t operator()(std::uint64_t row) const {
    return R > 4 ? low_[row & 15] | high_[row >> 4 & 15] : low_[row & 15];
  }

 private:
  static std::uint64_t row_bits(const AxisFill<R>& x, int cell) {
    return (std::uint64_t{2} << x.last[cell]) - (std::uint64_t{1} << x.first[cell]);
  }
  std::uint64_t low_[16] = {}, high_[R > 4 ? 16 : 1] = {};
};

/// Bit R*j for the rows of the ancestor that row y of the child fills.
template <int R>
std::uint64_t rows_filled(const AxisFill<R>& fill, int y) {
  std::uint64_t rows = 0;
  for (int j = fill.first[y]; j <= fill.last[y]; ++j) rows |= std::uint64_t{1} << (R * j);
  return rows;
}

/// What the occupied cells fill, one axis after the other: rows, then layers, then the whole.
template <int R>
MaskWords<R> fill_cells(const AxisFill<R> (&axes)[3], const std::uint64_t* child_mask) {
  constexpr std::uint64_t kRow = (std::uint64_t{1} << R) - 1;
  const RowFill<R> fill_row(axes[0]);
  std::uint64_t rows[R];
  for (int y = 0; y < R; ++y) rows[y] = rows_filled<R>(axes[1], y);
  std::uint64_t layers[R] = {};
  for (int z = 0; z < R; ++z) {
    const std::uint64_t from = layer_of<R>(child_mask, z);
    if (from == 0) continue;
    std::uint64_t to = 0;
    for (int y = 0; y < R; ++y) to |= fill_row(from >> (R * y) & kRow) * rows[y];
    for (int j = axes[2].first[z]; j <= axes[2].last[z]; ++j) layers[j] |= to;
  }
  MaskWords<R> cells{};
  for (int z = 0; z < R; ++z) add_layer<R>(cells, z, layers[z]);
  return cells;
}

}  // namespace detail

/// Sets in `mask`, over `box`, what `child_mask`, over `child` inside of it, occupies.
template <int R>
void fill_from(const BoxGrid<R>& grid, const Bounds& box, std::uint64_t* mask, const Bounds& child,
               const std::uint64_t* child_mask) {
  const CellRange range = closed_cells<R>(grid, child);
  const MaskWords<R> all = box_of_cells<R>(range);
  if (holds<R>(mask, all)) return;
  if (is_one_cell(range, grid.flat_axes)) return add_cells<R>(mask, all);

  Axes near[R + 1];
  detail::place_borders<R>(grid, child, near);
  const detail::AxisFill<R> axes[3] = {detail::make_axis_fill<R>(grid, box, child, near, 0),
                                       detail::make_axis_fill<R>(grid, box, child, near, 1),
                                       detail::make_axis_fill<R>(grid, box, child, near, 2)};
  add_cells<R>(mask, detail::fill_cells<R>(axes, child_mask));
}

}  // namespace ctu::cull
