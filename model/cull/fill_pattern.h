// Algorithm 2: the cells of a box that the occupied cells of a box below it fill.
//
// An occupied cell stands for whatever lies in it. Geometry on a border between two cells has set both, so a cell may
// count as half-open towards its upper neighbour, except at the faces of its box. Which side of an ancestor's border
// a child's border lies on is decided exactly: boxes share faces all the time, and an error margin there would
// dilate every mask by a layer (as the algorithm as printed does). The result holds every closed cell
// that the geometry touches.
#pragma once

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

template <int R>
AxisFill<R> make_axis_fill(const BoxGrid<R>& grid, const Bounds& box, const Bounds& child, int axis) {
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
  const double from = grid.to_grid(axis, child_lo), to = grid.to_grid(axis, child_hi);
  for (int x = 0; x <= R; ++x) {
    const double near = std::clamp(((R - x) * from + x * to) / R, 0.0, static_cast<double>(R));
    const BorderPlace place = place_border<R>(near, x, child_lo, child_hi, lo, hi);
    if (x < R) fill.first[x] = x == 0 ? place.below : place.at_or_below;
    if (x > 0) fill.last[x - 1] = x == R ? place.at_or_below : place.below;
  }
  for (int x = 0; x < R; ++x) fill.last[x] = std::max(fill.first[x], fill.last[x]);  // a flat child's borders coincide
  return fill;
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

  const detail::AxisFill<R> axes[3] = {detail::make_axis_fill<R>(grid, box, child, 0),
                                       detail::make_axis_fill<R>(grid, box, child, 1),
                                       detail::make_axis_fill<R>(grid, box, child, 2)};
  for (int w = 0; w < kWords<R>; ++w)
    for (std::uint64_t rest = child_mask[w]; rest != 0; rest &= rest - 1) {
      const int cell = 64 * w + std::countr_zero(rest);
      const int x = cell % R, y = cell / R % R, z = cell / (R * R);
      add_cells<R>(mask, box_of_cells<R>({{axes[0].first[x], axes[1].first[y], axes[2].first[z]},
                                          {axes[0].last[x], axes[1].last[y], axes[2].last[z]}}));
    }
}

}  // namespace ctu::cull
