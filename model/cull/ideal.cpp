// The grid walk of Amanatides and Woo with an enclosure for the time of every border instead of a number. The walk
// keeps, per axis, the cells the ray may be in: behind borders possibly passed, not behind borders certainly left.
// Almost always that is one cell and the walk is the usual one; where borders of two axes fall together, or the ray
// runs in a border, it marks the cells on both sides.
//
// Error bound. A border's time is ((R-k) lo + k hi - R o) / (R d) with binary32 inputs: products with R <= 8 are exact
// in binary64, two sums and a quotient round, together less than 2^-51 (|lo| + |hi| + |o|) / |d|. The margin
// is twice that, which covers the rounding of the bound itself.
#include "model/cull/ideal.h"

#include <algorithm>
#include <cmath>

#include "model/cull/cell_bits.h"

namespace ctu::cull {
namespace {

/// Borders 0..R of one axis in the order the ray meets them, and the walk's place among the inner ones.
template <int R>
struct AxisWalk {
  double earliest[R + 1], latest[R + 1];
  int first = 0, last = 0;  ///< cells, in ray order, that the ray may be in
  bool descending = false;
  bool moving = true;

  void advance(double time) {
    while (last < R - 1 && earliest[last + 1] <= time) ++last;
    while (first < last && latest[first + 1] < time) ++first;
  }
  double next_time() const { return moving && last < R - 1 ? earliest[last + 1] : HUGE_VAL; }
};

template <int R>
AxisWalk<R> make_walk(const intersect::PreparedRay& ray, const intersect::Box4& boxes, int lane, int axis) {
  AxisWalk<R> walk;
  const double lo = boxes.lo[axis][lane], hi = boxes.hi[axis][lane], origin = ray.ray.origin[axis];
  const double direction = ray.ray.direction[axis];
  walk.moving = direction != 0;
  walk.descending = direction < 0;
  const double step = walk.moving ? std::fabs(direction) : 1.0;
  const double margin = 0x1p-50 * (std::fabs(lo) + std::fabs(hi) + std::fabs(origin)) / step;
  for (int k = 0; k <= R; ++k) {
    const int plane = walk.descending ? R - k : k;
    const double distance = (R - plane) * lo + plane * hi - R * origin;
    const double value = (walk.descending ? -distance : distance) / (R * step);
    walk.earliest[k] = value - margin;
    walk.latest[k] = value + margin;
  }
  // An axis without motion stands at "time" 0 among its borders for the whole walk.
  if (!walk.moving) walk.advance(0);
  return walk;
}

template <int R>
void walk_grid(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
               int lane, std::uint64_t* words) {
  AxisWalk<R> axes[3];
  double time = times.t0[lane], stop = times.t1[lane];
  for (int a = 0; a < 3; ++a) {
    axes[a] = make_walk<R>(ray, boxes, lane, a);
    if (!axes[a].moving) continue;
    time = std::max(time, axes[a].earliest[0]);
    stop = std::min(stop, axes[a].latest[R]);
  }
  // A box hit by rounding alone, or entered after the best hit by less than its rounding, keeps the cell at its entry:
  // the walk culls by cells, not by a sharper box test.
  time = std::min(time, stop);
  std::fill_n(words, kWords<R>, 0);
  while (time <= stop) {
    CellRange range;
    double next = HUGE_VAL;
    for (int a = 0; a < 3; ++a) {
      AxisWalk<R>& axis = axes[a];
      if (axis.moving) axis.advance(time);
      range.first[a] = axis.descending ? R - 1 - axis.last : axis.first;
      range.last[a] = axis.descending ? R - 1 - axis.first : axis.last;
      next = std::min(next, axis.next_time());
    }
    const MaskWords<R> cells = box_of_cells<R>(range);
    for (int w = 0; w < kWords<R>; ++w) words[w] |= cells[w];
    if (next == HUGE_VAL) break;
    time = next;
  }
}

}  // namespace

void ideal_mask(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
                int lane, int resolution, std::uint64_t* words) {
  with_resolution(resolution, [&](auto r) { walk_grid<r()>(ray, times, boxes, lane, words); });
}

}  // namespace ctu::cull
