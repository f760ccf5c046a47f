// The paper's cells as the ray's own times see them. On each axis, cell i holds the ray from the time of its first
// border to that of its second; the cell (i, j, k) is touched iff these three closed intervals and [t0, t1] share a
// time, that is, iff they meet in pairs (Helly on the line). First borders are rounded down, second ones up, so
// every closed cell that the ray touches in exact arithmetic is kept.
#include "model/cull/comparators.h"

#include <limits>

#include "model/cull/cell_bits.h"
#include "model/cull/plane_times.h"

namespace ctu::cull {
namespace {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// When the ray is in each cell of one axis, within [t0, t1]; cells in the order of ray time. A cell that it is never
/// in has [+inf, -inf], which meets nothing: the others begin at tmin or later, which is finite. So do the elements
/// past the last cell.
template <int R>
struct CellTimes {
  static constexpr int kGroups = (R + 3) / 4;
  Float4 enter[kGroups], leave[kGroups];
  bool descending = false;  ///< ray order is cell order reversed
};

/// Elements i..i+3 of the borders 0..R: face, inner planes, face.
template <int R>
Float4 borders_from(const Float4* planes, float first, float second, int i) {
  Float4 out;
  for (int e = 0; e < 4; ++e) {
    const int k = i + e;
    out[e] = k == 0 ? first : k >= R ? second : planes[(k - 1) / 4][(k - 1) % 4];
  }
  return out;
}

template <int R>
CellTimes<R> cell_times(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                        const intersect::Box4& boxes, int lane, int axis, const LerpWeights& weights) {
  const bool still = (ray.zero_axes >> axis & 1) != 0;
  const float lo = boxes.lo[axis][lane], hi = boxes.hi[axis][lane];
  const float first_down = still ? lo : times.near_down[axis][lane], first_up = still ? lo : times.near_up[axis][lane];
  const float second_down = still ? hi : times.far_down[axis][lane], second_up = still ? hi : times.far_up[axis][lane];
  Float4 down[plane_groups(R)], up[plane_groups(R)];
  for (int g = 0; g < plane_groups(R); ++g) {
    down[g] = lerp_planes<Round::Down>(weights, g, first_down, second_down);
    up[g] = lerp_planes<Round::Up>(weights, g, first_up, second_up);
  }

  const Float4 t0 = numeric::splat(times.t0[lane]), t1 = numeric::splat(times.t1[lane]);
  const Float4 never = numeric::splat(kInfinity), position = numeric::splat(ray.ray.origin[axis]);
  CellTimes<R> cells;
  cells.descending = (ray.negative_axes >> axis & 1) != 0;
  for (int g = 0; g < CellTimes<R>::kGroups; ++g) {
    Float4 enter = borders_from<R>(down, first_down, second_down, 4 * g);
    Float4 leave = borders_from<R>(up, first_up, second_up, 4 * g + 1);
    numeric::Mask4 touched;
    if (still) {
      touched = (enter <= position) & (position <= leave);
      enter = t0;
      leave = t1;
    } else {
      enter = enter > t0 ? enter : t0;
      leave = leave < t1 ? leave : t1;
      touched = ~(enter > leave);
    }
    for (int e = 0; e < 4; ++e)
      if (4 * g + e >= R) touched[e] = 0;
    cells.enter[g] = touched ? enter : never;
    cells.leave[g] = touched ? leave : -never;
  }
  return cells;
}

/// Reverses the R bits of a row, or leaves them.
template <int R>
struct RowOrder {
  std::uint8_t of[2][1 << R];
};
template <int R>
constexpr RowOrder<R> make_row_order() {
  RowOrder<R> order{};
  for (unsigned row = 0; row < (1u << R); ++row) {
    order.of[0][row] = static_cast<std::uint8_t>(row);
    for (int i = 0; i < R; ++i)
      if ((row >> i & 1) != 0) order.of[1][row] |= static_cast<std::uint8_t>(1u << (R - 1 - i));
  }
  return order;
}
template <int R>
inline constexpr RowOrder<R> kRowOrder = make_row_order<R>();

/// Bit i + R*j: cell i of `a` and cell j of `b` share a time.
template <int R>
std::uint64_t meeting_cells(const CellTimes<R>& a, const CellTimes<R>& b) {
  const auto& order = kRowOrder<R>.of[a.descending];
  std::uint64_t bits = 0;
  for (int j = 0; j < R; ++j) {
    const Float4 enter = numeric::splat(b.enter[j / 4][j % 4]), leave = numeric::splat(b.leave[j / 4][j % 4]);
    unsigned row = 0;
    for (int g = 0; g < CellTimes<R>::kGroups; ++g)
      row |= set_lanes((a.enter[g] <= leave) & (enter <= a.leave[g])) << (4 * g);
    bits |= static_cast<std::uint64_t>(order[row]) << (R * (b.descending ? R - 1 - j : j));
  }
  return bits;
}

template <int R>
void mask_of(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
             int lane, std::uint64_t* words) {
  const LerpWeights& weights = lerp_weights(R);
  const CellTimes<R> x = cell_times<R>(ray, times, boxes, lane, 0, weights);
  const CellTimes<R> y = cell_times<R>(ray, times, boxes, lane, 1, weights);
  const CellTimes<R> z = cell_times<R>(ray, times, boxes, lane, 2, weights);
  const auto mask = and_of_projections<R>(meeting_cells(x, y), meeting_cells(y, z), meeting_cells(x, z));
  for (int w = 0; w < kWords<R>; ++w) words[w] = mask[w];
}

}  // namespace

void comparator_mask(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
                     int lane, int resolution, std::uint64_t* words) {
  with_resolution(resolution, [&](auto r) { mask_of<r()>(ray, times, boxes, lane, words); });
}

}  // namespace ctu::cull
