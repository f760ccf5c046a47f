// Bits of an R^3 mask, composed from what is known per axis or per pair of axes. R is a template argument: it is
// chosen once, outside the loops, by with_resolution().
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <type_traits>

#include "model/cull/options.h"

namespace ctu::cull {

template <int R>
inline constexpr int kWords = words_per_mask(R);
template <int R>
using MaskWords = std::array<std::uint64_t, kWords<R>>;

/// Calls `body(std::integral_constant<int, R>)` for the given resolution.
template <class Body>
decltype(auto) with_resolution(int resolution, Body&& body) {
  switch (resolution) {
    case 2:
      return body(std::integral_constant<int, 2>{});
    case 3:
      return body(std::integral_constant<int, 3>{});
    case 5:
      return body(std::integral_constant<int, 5>{});
    case 6:
      return body(std::integral_constant<int, 6>{});
    case 7:
      return body(std::integral_constant<int, 7>{});
    case 8:
      return body(std::integral_constant<int, 8>{});
    default:
      assert(resolution == 4);
      return body(std::integral_constant<int, 4>{});
  }
}

/// For each axis and index range, the cells of the grid whose index on that axis lies in the range. The AND of three
/// is a box of cells: the paper's six-dimensional filling-pattern table (3.2.1), factored.
template <int R>
struct RangeMasks {
  MaskWords<R> bits[3][R][R];  ///< [axis][first][last]
};

template <int R>
constexpr RangeMasks<R> make_range_masks() {
  RangeMasks<R> masks{};
  for (int cell = 0; cell < R * R * R; ++cell) {
    const int index[3] = {cell % R, cell / R % R, cell / (R * R)};
    for (int axis = 0; axis < 3; ++axis)
      for (int first = 0; first <= index[axis]; ++first)
        for (int last = index[axis]; last < R; ++last)
          masks.bits[axis][first][last][static_cast<std::size_t>(cell / 64)] |= std::uint64_t{1} << (cell % 64);
  }
  return masks;
}
template <int R>
inline const RangeMasks<R> kRangeMasks = make_range_masks<R>();

/// Indices first..last on each axis; empty when first > last somewhere.
struct CellRange {
  int first[3], last[3];
};

template <int R>
MaskWords<R> box_of_cells(const CellRange& range) {
  const auto& x = kRangeMasks<R>.bits[0][range.first[0]][range.last[0]];
  const auto& y = kRangeMasks<R>.bits[1][range.first[1]][range.last[1]];
  const auto& z = kRangeMasks<R>.bits[2][range.first[2]][range.last[2]];
  MaskWords<R> words;
  for (int w = 0; w < kWords<R>; ++w) words[w] = x[w] & y[w] & z[w];
  return words;
}

/// Whether `mask` holds every bit of `cells`.
template <int R>
bool holds(const std::uint64_t* mask, const MaskWords<R>& cells) {
  std::uint64_t missing = 0;
  for (int w = 0; w < kWords<R>; ++w) missing |= cells[w] & ~mask[w];
  return missing == 0;
}

/// Bit x of a row of R cells becomes the R bits R*x .. R*x + R-1.
template <int R>
struct Stretch {
  std::uint64_t of[1 << R];
};
template <int R>
constexpr Stretch<R> make_stretch() {
  Stretch<R> table{};
  for (unsigned row = 0; row < (1u << R); ++row)
    for (int i = 0; i < R; ++i)
      if ((row >> i & 1) != 0) table.of[row] |= ((std::uint64_t{1} << R) - 1) << (R * i);
  return table;
}
template <int R>
inline constexpr Stretch<R> kStretch = make_stretch<R>();

/// Sets the cells of layer z whose bits, x + R*y, are set in `layer`.
template <int R>
void add_layer(MaskWords<R>& words, int z, std::uint64_t layer) {
  const int bit = R * R * z;
  words[bit / 64] |= layer << (bit % 64);
  if (bit % 64 + R * R > 64) words[bit / 64 + 1] |= layer >> (64 - bit % 64);
}

/// The cells of layer z as bits x + R*y.
template <int R>
std::uint64_t layer_of(const std::uint64_t* mask, int z) {
  constexpr std::uint64_t kLayer = R == 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << (R * R % 64)) - 1;
  const int bit = R * R * z;
  std::uint64_t layer = mask[bit / 64] >> (bit % 64);
  if (bit % 64 + R * R > 64) layer |= mask[bit / 64 + 1] << (64 - bit % 64);
  return layer & kLayer;
}

/// cell (x, y, z) = xy(x, y) AND yz(y, z) AND xz(x, z). A pair's matrix has bit i + R*j for cell i of its first axis
/// and j of its second. By Helly's theorem on the line, sets of cells that are defined by three intervals of ray
/// time meeting are exactly such products (DESIGN section 4).
template <int R>
MaskWords<R> and_of_projections(std::uint64_t xy, std::uint64_t yz, std::uint64_t xz) {
  constexpr std::uint64_t kRow = (std::uint64_t{1} << R) - 1;
  constexpr std::uint64_t kEveryRow = [] {
    std::uint64_t bits = 0;
    for (int y = 0; y < R; ++y) bits |= std::uint64_t{1} << (R * y);
    return bits;
  }();
  MaskWords<R> words{};
  for (int z = 0; z < R; ++z)
    add_layer<R>(words, z, xy & kStretch<R>.of[yz >> (R * z) & kRow] & (xz >> (R * z) & kRow) * kEveryRow);
  return words;
}

}  // namespace ctu::cull
