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
//
// Where the triangle's bounds lie in one cell along an axis, the triangle lies between the planes of that layer, and it
// touches a cell of the layer where its projection along the axis touches the cell's: the other two projections and the
// plane have nothing to add and are left out. Cells of a row, and axes or projections, are worked on side by side.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "model/cull/cell_bits.h"
#include "model/numeric/vec3.h"

namespace ctu::cull {

struct Bounds {
  Vec3 lower, upper;
};

/// x, y, z and a lane that carries nothing: the same operation on the three axes at once.
typedef double Axes __attribute__((vector_size(32)));

/// The map from space to the grid of a box. A flat axis (lower == upper) maps to the middle of cell 0, and whatever
/// touches that layer is repeated in every cell of the axis.
template <int R>
struct BoxGrid {
  Axes lower, scale, shift;
  unsigned flat_axes = 0;

  explicit BoxGrid(const Bounds& box) {
    lower = Axes{box.lower.x, box.lower.y, box.lower.z, 0};
    const Axes extent = Axes{box.upper.x, box.upper.y, box.upper.z, 0} - lower;
    scale = extent > 0 ? R / extent : Axes{};
    shift = extent > 0 ? Axes{} : Axes{0.5, 0.5, 0.5, 0};
    for (int a = 0; a < 3; ++a) flat_axes |= extent[a] > 0 ? 0 : 1u << a;
  }
  double to_grid(int axis, float x) const { return (x - lower[axis]) * scale[axis] + shift[axis]; }
  void to_grid(const Vec3& v, Axes& u) const { u = (Axes{v.x, v.y, v.z, 0} - lower) * scale + shift; }
};

/// Closed cells that meet [low, high] on each axis, in grid coordinates; one on a flat axis.
template <int R>
CellRange closed_cells(const Axes& low, const Axes& high) {
  typedef std::int32_t Cells __attribute__((vector_size(16)));
  constexpr double kMargin = 0x1p-45, kMost = R - 0.5;
  Axes from = low - kMargin, to = high + kMargin;
  from = from > 0 ? (from < kMost ? from : Axes{} + kMost) : Axes{};
  to = to > 0 ? (to < kMost ? to : Axes{} + kMost) : Axes{};
  // ceil(from) - 1: the cell under a border that `from` is on.
  const Cells floor = __builtin_convertvector(from, Cells), last = __builtin_convertvector(to, Cells);
  const Cells on_border = __builtin_convertvector(from == __builtin_convertvector(floor, Axes), Cells);
  const Cells below = floor + on_border, first = below > 0 ? below : Cells{};
  return {{first[0], first[1], first[2]}, {last[0], last[1], last[2]}};
}

/// Closed cells that meet a box; all of them along a flat axis. Grows with the box, rounding included.
template <int R>
CellRange closed_cells(const BoxGrid<R>& grid, const Bounds& box) {
  Axes low, high;
  grid.to_grid(box.lower, low);
  grid.to_grid(box.upper, high);
  CellRange range = closed_cells<R>(low, high);
  if (grid.flat_axes != 0)
    for (int a = 0; a < 3; ++a)
      if ((grid.flat_axes >> a & 1) != 0) range.last[a] = R - 1;
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

/// A triangle in grid coordinates.
struct GridTriangle {
  Axes u[3];  ///< vertices
  Axes low, high;
  double edge_margin, plane_margin;
};

template <int R>
GridTriangle to_grid(const BoxGrid<R>& grid, const Vec3& v0, const Vec3& v1, const Vec3& v2) {
  GridTriangle t;
  grid.to_grid(v0, t.u[0]);
  grid.to_grid(v1, t.u[1]);
  grid.to_grid(v2, t.u[2]);
  t.low = t.u[0] < t.u[1] ? t.u[0] : t.u[1];
  t.low = t.low < t.u[2] ? t.low : t.u[2];
  t.high = t.u[0] > t.u[1] ? t.u[0] : t.u[1];
  t.high = t.high > t.u[2] ? t.high : t.u[2];
  double most = 8;
  for (int a = 0; a < 3; ++a) most = std::max({most, -t.low[a], t.high[a]});
  t.edge_margin = 0x1p-46 * most * most;
  t.plane_margin = 0x1p-43 * most * most * most;
  return t;
}

/// The projections onto two axes (a, b), one a lane: x y, y z, x z.
enum Projection : int { kXy, kYz, kXz };
inline constexpr int kAcross[3] = {0, 1, 0}, kUp[3] = {1, 2, 2};  ///< a and b

/// The three edges' tests in the three projections: cell (i, j) passes when least <= na * i + nb * j <= most.
struct EdgeTests {
  Axes na[3], nb[3], least[3], most[3];  ///< [edge], a lane a projection
};

inline void make_edge_tests(const GridTriangle& t, EdgeTests& tests) {
  Axes a[3], b[3];
  for (int v = 0; v < 3; ++v) {
    a[v] = __builtin_shufflevector(t.u[v], t.u[v], 0, 1, 0, 3);
    b[v] = __builtin_shufflevector(t.u[v], t.u[v], 1, 2, 2, 3);
  }
  for (int e = 0; e < 3; ++e) {
    const int q = (e + 1) % 3, r = (e + 2) % 3;
    const Axes na = b[e] - b[q], nb = a[q] - a[e];
    const Axes edge = na * a[e] + nb * b[e], opposite = na * a[r] + nb * b[r];
    // The cell's own extent along the normal, from its lower corner.
    const Axes below = (na < 0 ? na : Axes{}) + (nb < 0 ? nb : Axes{});
    const Axes above = (na > 0 ? na : Axes{}) + (nb > 0 ? nb : Axes{});
    tests.na[e] = na;
    tests.nb[e] = nb;
    tests.least[e] = (edge < opposite ? edge : opposite) - above - t.edge_margin;
    tests.most[e] = (edge > opposite ? edge : opposite) - below + t.edge_margin;
  }
}

typedef double Row4 __attribute__((vector_size(32)));
typedef double Row8 __attribute__((vector_size(64)));
typedef std::int64_t RowBits4 __attribute__((vector_size(32)));
typedef std::int64_t RowBits8 __attribute__((vector_size(64)));

/// A row of cells at once, a lane a cell: in R^2 bits of a layer, bit i + R*j is in lane i.
template <int R>
struct Rows {
  using Row = std::conditional_t<(R > 4), Row8, Row4>;
  using Bits = std::conditional_t<(R > 4), RowBits8, RowBits4>;
  Row i{};       ///< the cells' numbers
  Bits bit{};    ///< bit i, of the R cells that there are
  Bits layer{};  ///< what has been added

  Rows() {
    for (int lane = 0; lane < R; ++lane) {
      i[lane] = lane;
      bit[lane] = std::int64_t{1} << lane;
    }
  }
  void add(int j, const Bits& row) { layer |= row << (R * j); }
  std::uint64_t bits() const {
    std::uint64_t all = 0;
    for (unsigned lane = 0; lane < sizeof(Bits) / sizeof(std::int64_t); ++lane)
      all |= static_cast<std::uint64_t>(layer[lane]);
    return all;
  }
};

/// Bit i + R*j, for the cells of the range: the rectangle of them.
template <int R>
std::uint64_t rectangle(const CellRange& range, int a, int b) {
  const std::uint64_t row = ((std::uint64_t{2} << range.last[a]) - 1) & ~((std::uint64_t{1} << range.first[a]) - 1);
  std::uint64_t cells = 0;
  for (int j = range.first[b]; j <= range.last[b]; ++j) cells |= row << (R * j);
  return cells;
}

/// Bit i + R*j: the projection touches cell (i, j), for cells in the range.
template <int R>
std::uint64_t projection_cells(const EdgeTests& tests, int p, const CellRange& range) {
  Rows<R> rows;
  for (int j = range.first[kUp[p]]; j <= range.last[kUp[p]]; ++j) {
    typename Rows<R>::Bits touched = rows.bit;
    for (int e = 0; e < 3; ++e) {
      const typename Rows<R>::Row corner = tests.na[e][p] * rows.i + tests.nb[e][p] * j;
      touched &= (corner >= tests.least[e][p]) & (corner <= tests.most[e][p]);
    }
    rows.add(j, touched);
  }
  return rows.bits() & rectangle<R>(range, kAcross[p], kUp[p]);
}

/// The cells of the range that the triangle's three projections touch.
template <int R>
MaskWords<R> cells_of_projections(const GridTriangle& t, const CellRange& range) {
  EdgeTests tests;
  make_edge_tests(t, tests);
  std::uint64_t cells[3];
  for (const Projection p : {kXy, kYz, kXz}) {
    const int a = kAcross[p], b = kUp[p];
    const bool strip = range.first[a] == range.last[a] || range.first[b] == range.last[b];
    cells[p] = strip ? rectangle<R>(range, a, b) : projection_cells<R>(tests, p, range);
  }
  return and_of_projections<R>(cells[kXy], cells[kYz], cells[kXz]);
}

/// Of the cells in the range, those that the triangle's plane touches.
template <int R>
MaskWords<R> cells_on_plane(const GridTriangle& t, const CellRange& range) {
  const Axes e1 = t.u[1] - t.u[0], e2 = t.u[2] - t.u[0];
  const double n[3] = {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]};
  double plane = 0, below = 0, above = 0;
  for (int a = 0; a < 3; ++a) {
    plane += n[a] * t.u[0][a];
    below += std::min(n[a], 0.0);
    above += std::max(n[a], 0.0);
  }
  const double least = plane - above - t.plane_margin, most = plane - below + t.plane_margin;
  MaskWords<R> cells{};
  for (int z = range.first[2]; z <= range.last[2]; ++z) {
    Rows<R> rows;
    for (int y = range.first[1]; y <= range.last[1]; ++y) {
      const typename Rows<R>::Row corner = n[0] * rows.i + n[1] * y + n[2] * z;
      rows.add(y, rows.bit & (corner >= least) & (corner <= most));
    }
    add_layer<R>(cells, z, rows.bits());
  }
  return cells;
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
  const detail::GridTriangle triangle = detail::to_grid<R>(grid, v0, v1, v2);
  const CellRange range = closed_cells<R>(triangle.low, triangle.high);
  MaskWords<R> cells = box_of_cells<R>(range);
  // Along the others the triangle lies in one cell.
  const int thick_axes =
      (range.first[0] != range.last[0]) + (range.first[1] != range.last[1]) + (range.first[2] != range.last[2]);
  if (thick_axes > 1) {
    if (grid.flat_axes == 0 && holds<R>(mask, cells)) return;
    cells = detail::cells_of_projections<R>(triangle, range);
  }
  if (thick_axes > 2) {
    if (holds<R>(mask, cells)) return;  // what is known need not meet the plane test
    const MaskWords<R> on_plane = detail::cells_on_plane<R>(triangle, range);
    for (int w = 0; w < kWords<R>; ++w) cells[w] &= on_plane[w];
  }
  if (grid.flat_axes != 0)
    for (int a = 0; a < 3; ++a)
      if ((grid.flat_axes >> a & 1) != 0) detail::repeat_layer<R>(cells, a);
  add_cells<R>(mask, cells);
}

}  // namespace ctu::cull
