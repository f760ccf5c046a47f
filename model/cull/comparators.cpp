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

/// When the ray is in each cell of one axis, in cell order, within [t0, t1]. A cell that it is never in has
/// [+inf, -inf], which meets nothing: the others begin at tmin or later, which is finite.
template <int R> struct CellTimes {
  static constexpr int kGroups = (R + 3) / 4;
  alignas(16) float enter[4 * kGroups];
  alignas(16) float leave[4 * kGroups];

  CellTimes() {
    for (int i = R; i < 4 * kGroups; ++i) set(i, kInfinity, -kInfinity);
  }
  void set(int cell, float from, float to) {
    const bool touched = !(from > to);
    enter[cell] = touched ? from : kInfinity;
    leave[cell] = touched ? to : -kInfinity;
  }
};

/// Borders 0..R of the cells from the two faces and the inner planes.
template <Round M, int R> void borders(float first, float second, float (&out)[R + 4]) {
  const LerpWeights& weights = lerp_weights(R);
  out[0] = first;
  for (int g = 0; g < plane_groups(R); ++g) numeric::store4(out + 1 + 4 * g, lerp_planes<M>(weights, g, first, second));
  out[R] = second;
}

template <int R>
void fill(CellTimes<R>& cells, const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
          const intersect::Box4& boxes, int lane, int axis) {
  const float t0 = times.t0[lane], t1 = times.t1[lane];
  float down[R + 4], up[R + 4];
  if ((ray.zero_axes >> axis & 1) != 0) {
    borders<Round::Down, R>(boxes.lo[axis][lane], boxes.hi[axis][lane], down);
    borders<Round::Up, R>(boxes.lo[axis][lane], boxes.hi[axis][lane], up);
    const float position = ray.ray.origin[axis];
    for (int i = 0; i < R; ++i) {
      const bool inside = down[i] <= position && position <= up[i + 1];
      cells.set(i, inside ? t0 : kInfinity, inside ? t1 : -kInfinity);
    }
    return;
  }
  borders<Round::Down, R>(times.near_down[axis][lane], times.far_down[axis][lane], down);
  borders<Round::Up, R>(times.near_up[axis][lane], times.far_up[axis][lane], up);
  const bool descending = (ray.negative_axes >> axis & 1) != 0;
  for (int i = 0; i < R; ++i)
    cells.set(descending ? R - 1 - i : i, down[i] > t0 ? down[i] : t0, up[i + 1] < t1 ? up[i + 1] : t1);
}

/// Bit i + R*j: cell i of `a` and cell j of `b` share a time.
template <int R> std::uint64_t meeting_cells(const CellTimes<R>& a, const CellTimes<R>& b) {
  std::uint64_t bits = 0;
  for (int j = 0; j < R; ++j) {
    const Float4 enter = numeric::splat(b.enter[j]), leave = numeric::splat(b.leave[j]);
    for (int g = 0; g < CellTimes<R>::kGroups; ++g) {
      const auto meets = (numeric::load4(a.enter + 4 * g) <= leave) & (enter <= numeric::load4(a.leave + 4 * g));
      bits |= static_cast<std::uint64_t>(set_lanes(meets)) << (R * j + 4 * g);
    }
  }
  return bits;
}

template <int R>
void mask_of(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
             int lane, std::uint64_t* words) {
  CellTimes<R> axis[3];
  for (int a = 0; a < 3; ++a) fill<R>(axis[a], ray, times, boxes, lane, a);
  const auto mask = and_of_projections<R>(meeting_cells<R>(axis[0], axis[1]), meeting_cells<R>(axis[1], axis[2]),
                                          meeting_cells<R>(axis[0], axis[2]));
  for (int w = 0; w < kWords<R>; ++w) words[w] = mask[w];
}

}  // namespace

void comparator_mask(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
                     int lane, int resolution, std::uint64_t* words) {
  with_resolution(resolution, [&](auto r) { mask_of<r()>(ray, times, boxes, lane, words); });
}

}  // namespace ctu::cull
