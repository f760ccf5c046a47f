// Conservative voxelization of a triangle into the closed cells of a box's R^3 grid (paper 3.1.1), by separating axes
// (Akenine-Moeller 2001) split as Schwarz and Seidel 2010 do: the triangle's bounds, three projections with three edges
// each, the triangle's plane.
//
// Everything happens in grid coordinates u = (x - lower) * R / (upper - lower), in binary64, where cells are unit
// cubes: an affine change of coordinates keeps what touches what, and boxes of any aspect look alike.
//
// Error bounds, for |u| <= M with M >= 8. Inputs are binary32, so x - lower rounds once; u has a relative error below
// 4 * 2^-53 and an absolute one below d = M 2^-51. Edges are differences of two u: at most 2 M, off by less than 3 d.
// An edge's offset, two products of an edge's component and u, is off by less than 12 M d, its terms for a cell by less
// than 9 M d more: together below 2^-46 M^2. The plane's normal, two products of edges each, is off by less than 28 M
// d, its offset by less than 126 M^2 d, its terms for a cell by less than 103 M^2 d: together below 2^-43 M^3. An axis
// separates only when its gap exceeds these bounds, so no touched cell is lost; for a box that holds its triangles
// M = 8, and a cell is marked in vain only when the triangle passes it by some 1e-11 of a cell or less, over the
// length of the edge or the normal.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

#include "model/cull/cell_bits.h"
#include "model/numeric/vec3.h"

namespace ctu::cull {

struct Bounds {
  Vec3 lower, upper;
};

/// The map from space to the grid of a box. A flat axis (lower == upper) maps to the middle of cell 0, and whatever
/// touches that layer is repeated in every cell of the axis.
template <int R>
struct BoxGrid {
  double lower[3], scale[3], shift[3];
  unsigned flat_axes = 0;

  explicit BoxGrid(const Bounds& box) {
    for (int a = 0; a < 3; ++a) {
      const double extent = static_cast<double>(box.upper[a]) - box.lower[a];
      const bool flat = !(extent > 0);
      lower[a] = box.lower[a];
      scale[a] = flat ? 0 : R / extent;
      shift[a] = flat ? 0.5 : 0;
      flat_axes |= flat ? 1u << a : 0;
    }
  }
  double to_grid(int axis, float x) const { return (x - lower[axis]) * scale[axis] + shift[axis]; }
};

/// Closed cells that meet [low, high] on one axis.
template <int R>
void closed_cells(double low, double high, int& first, int& last) {
  constexpr double kMargin = 0x1p-45;
  first = static_cast<int>(std::ceil(std::clamp(low - kMargin, 0.0, R - 0.5))) - 1;
  first = first < 0 ? 0 : first;
  last = static_cast<int>(std::clamp(high + kMargin, 0.0, R - 0.5));
}

/// Closed cells that meet a box; all of them along a flat axis. Grows with the box, rounding included.
template <int R>
CellRange closed_cells(const BoxGrid<R>& grid, const Bounds& box) {
  CellRange range;
  for (int a = 0; a < 3; ++a) {
    closed_cells<R>(grid.to_grid(a, box.lower[a]), grid.to_grid(a, box.upper[a]), range.first[a], range.last[a]);
    if ((grid.flat_axes >> a & 1) != 0) range.last[a] = R - 1;
  }
  return range;
}

/// Whether the range is one cell, flat axes aside: then whatever lies in the box touches just the range.
inline bool is_one_cell(const CellRange& range, unsigned flat_axes) {
  for (int a = 0; a < 3; ++a)
    if (range.first[a] != range.last[a] && (flat_axes >> a & 1) == 0) return false;
  return true;
}

template <int R>
void add_cells(std::uint64_t* mask, const MaskWords<R>& cells) {
  for (int w = 0; w < kWords<R>; ++w) mask[w] |= cells[w];
}

namespace detail {

struct GridTriangle {
  double u[3][3];  ///< [vertex][axis]
  double edge_margin, plane_margin;
};

template <int R>
GridTriangle to_grid(const BoxGrid<R>& grid, const Vec3& v0, const Vec3& v1, const Vec3& v2) {
  GridTriangle t;
  double most = 8;
  const Vec3* vertices[3] = {&v0, &v1, &v2};
  for (int v = 0; v < 3; ++v)
    for (int a = 0; a < 3; ++a) {
      t.u[v][a] = grid.to_grid(a, (*vertices[v])[a]);
      most = std::max(most, std::fabs(t.u[v][a]));
    }
  t.edge_margin = 0x1p-46 * most * most;
  t.plane_margin = 0x1p-43 * most * most * most;
  return t;
}

/// Bit i + R*j: the projection onto axes (a, b) touches cell (i, j), for cells in the range.
template <int R>
std::uint64_t projection_cells(const GridTriangle& t, int a, int b, const CellRange& range) {
  double na[3], nb[3], least[3], most[3];
  for (int e = 0; e < 3; ++e) {
    const double *p = t.u[e], *q = t.u[(e + 1) % 3], *r = t.u[(e + 2) % 3];
    na[e] = p[b] - q[b];
    nb[e] = q[a] - p[a];
    const double edge = na[e] * p[a] + nb[e] * p[b], opposite = na[e] * r[a] + nb[e] * r[b];
    // The cell's own extent along the normal, from its lower corner.
    const double below = std::min(na[e], 0.0) + std::min(nb[e], 0.0);
    const double above = std::max(na[e], 0.0) + std::max(nb[e], 0.0);
    least[e] = std::min(edge, opposite) - above - t.edge_margin;
    most[e] = std::max(edge, opposite) - below + t.edge_margin;
  }
  std::uint64_t cells = 0;
  for (int j = range.first[b]; j <= range.last[b]; ++j)
    for (int i = range.first[a]; i <= range.last[a]; ++i) {
      bool touched = true;
      for (int e = 0; e < 3; ++e) {
        const double corner = na[e] * i + nb[e] * j;
        touched &= (least[e] <= corner) & (corner <= most[e]);
      }
      cells |= static_cast<std::uint64_t>(touched) << (i + R * j);
    }
  return cells;
}

/// Removes the cells that the triangle's plane does not touch.
template <int R>
void keep_cells_on_plane(const GridTriangle& t, MaskWords<R>& cells) {
  double e1[3], e2[3];
  for (int a = 0; a < 3; ++a) {
    e1[a] = t.u[1][a] - t.u[0][a];
    e2[a] = t.u[2][a] - t.u[0][a];
  }
  const double n[3] = {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]};
  double plane = 0, below = 0, above = 0;
  for (int a = 0; a < 3; ++a) {
    plane += n[a] * t.u[0][a];
    below += std::min(n[a], 0.0);
    above += std::max(n[a], 0.0);
  }
  const double least = plane - above - t.plane_margin, most = plane - below + t.plane_margin;
  for (int w = 0; w < kWords<R>; ++w)
    for (std::uint64_t rest = cells[w]; rest != 0; rest &= rest - 1) {
      const int cell = 64 * w + std::countr_zero(rest);
      const double corner = n[0] * (cell % R) + n[1] * (cell / R % R) + n[2] * (cell / (R * R));
      if (!(least <= corner && corner <= most)) cells[w] &= ~(rest & (~rest + 1));
    }
}

/// Repeats cell 0's layer of a flat axis in every layer.
template <int R>
void repeat_layer(MaskWords<R>& cells, int axis) {
  const MaskWords<R> layer = cells;
  const int stride = axis == 0 ? 1 : axis == 1 ? R : R * R;
  for (int w = 0; w < kWords<R>; ++w)
    for (std::uint64_t rest = layer[w]; rest != 0; rest &= rest - 1)
      for (int i = 1; i < R; ++i) {
        const int cell = 64 * w + std::countr_zero(rest) + i * stride;
        cells[static_cast<std::size_t>(cell / 64)] |= std::uint64_t{1} << (cell % 64);
      }
}

}  // namespace detail

/// Sets the bits of the closed cells that the triangle touches. The triangle may be degenerate; it should lie in
/// the box (what sticks out is taken to the nearest cells by its bounds).
template <int R>
void add_triangle(const BoxGrid<R>& grid, const Vec3& v0, const Vec3& v1, const Vec3& v2, std::uint64_t* mask) {
  Bounds bounds;
  for (int a = 0; a < 3; ++a) {
    bounds.lower[a] = std::min({v0[a], v1[a], v2[a]});
    bounds.upper[a] = std::max({v0[a], v1[a], v2[a]});
  }
  CellRange range = closed_cells<R>(grid, bounds);
  const MaskWords<R> box = box_of_cells<R>(range);
  if (is_one_cell(range, grid.flat_axes)) return add_cells<R>(mask, box);
  if (holds<R>(mask, box)) return;

  for (int a = 0; a < 3; ++a)
    if ((grid.flat_axes >> a & 1) != 0) range.last[a] = 0;
  const detail::GridTriangle triangle = detail::to_grid<R>(grid, v0, v1, v2);
  MaskWords<R> cells = and_of_projections<R>(detail::projection_cells<R>(triangle, 0, 1, range),
                                             detail::projection_cells<R>(triangle, 1, 2, range),
                                             detail::projection_cells<R>(triangle, 0, 2, range));
  if (grid.flat_axes == 0)
    for (int w = 0; w < kWords<R>; ++w) cells[w] &= ~mask[w];  // what is known need not meet the plane test
  detail::keep_cells_on_plane<R>(triangle, cells);
  for (int a = 0; a < 3; ++a)
    if ((grid.flat_axes >> a & 1) != 0) detail::repeat_layer<R>(cells, a);
  add_cells<R>(mask, cells);
}

}  // namespace ctu::cull
