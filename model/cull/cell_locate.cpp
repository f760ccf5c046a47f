// Why the key is sound. Let [s0, s1] be the exact overlap of the ray with the box and its own range, if there is one:
// s0 lies in [t0, max(tmin, near_up..)] and s1 in [min(t1, far_down..), t1]. A cell is taken as certain only when its
// number is the same for every time of that range; then it is the floor cell of the exact first or last point of the
// overlap, which lies in the box, and of the point at t0 or t1, clamped, as well. The ray mask is the sweep of the
// half-open begin cell to the half-open end cell, so it holds the floor cell of every point between; the object mask
// holds every closed cell that geometry touches, hence the floor cell of any hit: their AND is not empty.
// (The points at t0 and t1 alone would not do: they may lie outside the box by rounding, and the sweep between
// clamped cells need not cover the segment between points outside of them.)
//
// A column. Where rounding leaves candidates on one axis only, and the overlap stays in one certain cell of each other
// axis, the key runs from the first candidate to the last: the sweep between them is just that column of cells, which
// holds the overlap whatever the truth is. It is what keeps boxes a few units in the last place thick (walls, floors)
// from being passed always.
#include "model/cull/cell_locate.h"

#include <algorithm>
#include <bit>

#include "model/cull/plane_times.h"

namespace ctu::cull {
namespace {

/// A time (or position) known to lie in [down, up].
struct Range {
  float down, up;
};

/// The cells that some value of a range lies in.
struct Cells {
  int first, last;
  bool certain() const { return first == last; }
};

/// The inner planes of one axis in the order of ray time (or of position, on an axis without motion); `Groups` of four.
template <int Groups>
class Planes {
 public:
  Planes(const LerpWeights& weights, int resolution, Range first, Range second) : inner_((1u << (resolution - 1)) - 1) {
    for (int g = 0; g < Groups; ++g) {
      down_[g] = lerp_planes<Round::Down>(weights, g, first.down, second.down);
      up_[g] = lerp_planes<Round::Up>(weights, g, first.up, second.up);
    }
  }

  /// The floor cells of the points at `value`: as many as planes at or below. Going up, a plane is below from the
  /// moment it is met on; going down, until after it is met.
  Cells cells_at(Range value, bool descending) const {
    const numeric::Mask4 passed_when_met = numeric::splat(descending ? 0 : -1);
    const Float4 down = numeric::splat(value.down), up = numeric::splat(value.up);
    unsigned passed = 0, ahead = 0;
    for (int g = 0; g < Groups; ++g) {
      passed |= set_lanes((up_[g] < down) | ((up_[g] == down) & passed_when_met)) << (4 * g);
      ahead |= set_lanes((down_[g] > up) | ((down_[g] == up) & ~passed_when_met)) << (4 * g);
    }
    // An undecided plane is in neither set; so would a NaN be.
    const int below = std::popcount((descending ? ahead : passed) & inner_);
    return {below, below + std::popcount(~(passed | ahead) & inner_)};
  }

 private:
  unsigned inner_;
  Float4 down_[Groups], up_[Groups];
};

/// One axis of the box: where the overlap may begin and end.
struct AxisCells {
  Cells begin{0, 0}, end{0, 0};
  bool certain() const { return begin.certain() && end.certain(); }
  bool one_cell() const { return certain() && begin.first == end.first; }
  /// All candidates.
  Cells span() const { return {std::min(begin.first, end.first), std::max(begin.last, end.last)}; }
};

template <int Groups>
AxisCells locate_axis(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                      const intersect::Box4& boxes, int lane, int ray_resolution, int axis, Range entry, Range exit) {
  const float lo = boxes.lo[axis][lane], hi = boxes.hi[axis][lane];
  // A flat box has one layer that the object mask repeats in every cell of the axis: any cell will do.
  if (lo == hi) return {};
  const LerpWeights& weights = lerp_weights(ray_resolution);
  if ((ray.zero_axes >> axis & 1) != 0) {
    const float position = ray.ray.origin[axis];
    const Cells cells =
        Planes<Groups>(weights, ray_resolution, {lo, lo}, {hi, hi}).cells_at({position, position}, false);
    return {cells, cells};
  }
  const Planes<Groups> planes(weights, ray_resolution, {times.near_down[axis][lane], times.near_up[axis][lane]},
                              {times.far_down[axis][lane], times.far_up[axis][lane]});
  const bool descending = (ray.negative_axes >> axis & 1) != 0;
  return {planes.cells_at(entry, descending), planes.cells_at(exit, descending)};
}

CellKey pack(const AxisCells (&axes)[3]) {
  int undecided = 0, undecided_axis = 0, several_cells = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!axes[axis].certain()) undecided_axis = axis, ++undecided;
    if (!axes[axis].one_cell()) ++several_cells;
  }
  CellKey key;
  for (int axis = 0; axis < 3; ++axis) {
    Cells begin_end{axes[axis].begin.first, axes[axis].end.first};
    if (undecided == 1 && several_cells == 1 && axis == undecided_axis) begin_end = axes[axis].span();
    key.set(axis, begin_end.first, begin_end.last);
  }
  if (undecided > 0 && several_cells > 1) key.packed |= CellKey::kUncertain;
  return key;
}

template <int Groups>
CellKey locate(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
               int lane, int ray_resolution) {
  Range entry{times.t0[lane], times.t0[lane]}, exit{times.t1[lane], times.t1[lane]};
  for (int axis = 0; axis < 3; ++axis) {
    entry.up = times.near_up[axis][lane] > entry.up ? times.near_up[axis][lane] : entry.up;
    exit.down = times.far_down[axis][lane] < exit.down ? times.far_down[axis][lane] : exit.down;
  }
  const AxisCells axes[3] = {locate_axis<Groups>(ray, times, boxes, lane, ray_resolution, 0, entry, exit),
                             locate_axis<Groups>(ray, times, boxes, lane, ray_resolution, 1, entry, exit),
                             locate_axis<Groups>(ray, times, boxes, lane, ray_resolution, 2, entry, exit)};
  return pack(axes);
}

}  // namespace

CellKey cell_locate(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
                    int lane, int ray_resolution) {
  switch (plane_groups(ray_resolution)) {
    case 1:
      return locate<1>(ray, times, boxes, lane, ray_resolution);
    case 2:
      return locate<2>(ray, times, boxes, lane, ray_resolution);
    case 3:
      return locate<3>(ray, times, boxes, lane, ray_resolution);
    case 4:
      return locate<4>(ray, times, boxes, lane, ray_resolution);
    case 5:
      return locate<5>(ray, times, boxes, lane, ray_resolution);
    default:
      static_assert(plane_groups(kMaxRayResolution) == 6);
      return locate<6>(ray, times, boxes, lane, ray_resolution);
  }
}

}  // namespace ctu::cull
