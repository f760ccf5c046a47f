// Why the key is sound. Let [s0, s1] be the exact overlap of the ray with the box and its own range, if there is one:
// s0 lies in [t0, max(tmin, near_up..)] and s1 in [min(t1, far_down..), t1]. A cell is taken as certain only when its
// number is the same for every time of that range; then it is the floor cell of the exact first or last point of the
// overlap, which lies in the box, and of the point at t0 or t1, clamped, as well. The ray mask is the sweep of the
// half-open begin cell to the half-open end cell, so it holds the floor cell of every point between; the object mask
// holds every closed cell that geometry touches, hence the floor cell of any hit: their AND is not empty.
// (The points at t0 and t1 alone would not do: they may lie outside the box by rounding, and the sweep between
// clamped cells need not cover the segment between points outside of them.)
#include "model/cull/cell_locate.h"

#include <bit>

#include "model/cull/plane_times.h"

namespace ctu::cull {
namespace {

/// A time (or position) known to lie in [down, up].
struct Range {
  float down, up;
};

struct Count {
  int planes;    ///< inner planes passed
  bool certain;  ///< by every value of the range
};

/// How many inner planes, the first at `first`, the last before `second`, lie at or before (`Closed`), or before, a
/// value of the range.
class PlaneCounter {
 public:
  PlaneCounter(int resolution, Range first, Range second) : inner_((1u << (resolution - 1)) - 1) {
    const LerpWeights& weights = lerp_weights(resolution);
    groups_ = plane_groups(resolution);
    for (int g = 0; g < groups_; ++g) {
      down_[g] = lerp_planes<Round::Down>(weights, g, first.down, second.down);
      up_[g] = lerp_planes<Round::Up>(weights, g, first.up, second.up);
    }
  }

  Count at_or_before(Range value) const {
    return count([&](int g) { return up_[g] <= numeric::splat(value.down); },
                 [&](int g) { return down_[g] > numeric::splat(value.up); });
  }
  Count before(Range value) const {
    return count([&](int g) { return up_[g] < numeric::splat(value.down); },
                 [&](int g) { return down_[g] >= numeric::splat(value.up); });
  }

 private:
  template <class Passed, class Ahead> Count count(Passed passed, Ahead ahead) const {
    unsigned passed_bits = 0, ahead_bits = 0;
    for (int g = 0; g < groups_; ++g) {
      passed_bits |= set_lanes(passed(g)) << (4 * g);
      ahead_bits |= set_lanes(ahead(g)) << (4 * g);
    }
    // An undecided plane is in neither set; so would a NaN be.
    return {std::popcount(passed_bits & inner_), ((passed_bits | ahead_bits) & inner_) == inner_};
  }

  unsigned inner_;
  int groups_;
  Float4 down_[kPlaneGroups], up_[kPlaneGroups];
};

/// Floor cells along an axis: planes at or below the point. Going down, a plane is at or below the point while it has
/// not been passed.
struct AxisCells {
  int begin, end;
  bool certain;
};

AxisCells along_zero_axis(int resolution, float lo, float hi, float origin) {
  const Count count = PlaneCounter(resolution, {lo, lo}, {hi, hi}).at_or_before({origin, origin});
  return {count.planes, count.planes, count.certain};
}

AxisCells along_axis(int resolution, Range near, Range far, Range entry, Range exit, bool descending) {
  const PlaneCounter planes(resolution, near, far);
  if (!descending) {
    const Count begin = planes.at_or_before(entry), end = planes.at_or_before(exit);
    return {begin.planes, end.planes, begin.certain && end.certain};
  }
  const Count begin = planes.before(entry), end = planes.before(exit);
  return {resolution - 1 - begin.planes, resolution - 1 - end.planes, begin.certain && end.certain};
}

}  // namespace

CellKey cell_locate(const intersect::PreparedRay& ray, const intersect::SlabTimes& times,
                    const intersect::Box4& boxes, int lane, int ray_resolution) {
  Range entry{times.t0[lane], times.t0[lane]}, exit{times.t1[lane], times.t1[lane]};
  for (int axis = 0; axis < 3; ++axis) {
    entry.up = times.near_up[axis][lane] > entry.up ? times.near_up[axis][lane] : entry.up;
    exit.down = times.far_down[axis][lane] < exit.down ? times.far_down[axis][lane] : exit.down;
  }

  CellKey key;
  for (int axis = 0; axis < 3; ++axis) {
    const float lo = boxes.lo[axis][lane], hi = boxes.hi[axis][lane];
    // A flat box has one layer that the object mask repeats in every cell of the axis: any cell will do.
    if (lo == hi) continue;
    const AxisCells cells =
        (ray.zero_axes >> axis & 1) != 0
            ? along_zero_axis(ray_resolution, lo, hi, ray.ray.origin[axis])
            : along_axis(ray_resolution, {times.near_down[axis][lane], times.near_up[axis][lane]},
                         {times.far_down[axis][lane], times.far_up[axis][lane]}, entry, exit,
                         (ray.negative_axes >> axis & 1) != 0);
    key.packed |= static_cast<std::uint32_t>(cells.begin) << (4 * axis);
    key.packed |= static_cast<std::uint32_t>(cells.end) << (12 + 4 * axis);
    if (!cells.certain) key.packed |= CellKey::kUncertain;
  }
  return key;
}

}  // namespace ctu::cull
