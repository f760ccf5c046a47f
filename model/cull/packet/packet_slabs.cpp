#include "model/cull/packet/packet_slabs.h"

#include "model/numeric/round.h"

namespace ctu::cull::packet {

using numeric::max;
using numeric::min;
using numeric::Round;

namespace {

/// A distance along the axis times the reciprocal that makes it an outer bound, as in slab_test: zero whatever the
/// reciprocal where there is no distance.
template <Round M>
float time_of(float distance, float rcp_small, float rcp_large) {
  if (distance == 0) return 0;
  const bool small = (distance > 0) == (M == Round::Down);
  return numeric::mul<M>(distance, small ? rcp_small : rcp_large);
}

}  // namespace

void PacketSlabs::add(const intersect::PreparedRay& ray) {
  for (int i = 0; i < 3; ++i) {
    Axis& axis = axis_[i];
    axis.origin_lo = min(axis.origin_lo, ray.ray.origin[i]);
    axis.origin_hi = max(axis.origin_hi, ray.ray.origin[i]);
    if ((ray.zero_axes >> i & 1) != 0) {
      axis.still = true;
      continue;
    }
    ((ray.negative_axes >> i & 1) != 0 ? axis.down : axis.up) = true;
    axis.rcp_lo = min(axis.rcp_lo, ray.rcp_down[i]);
    axis.rcp_hi = max(axis.rcp_hi, ray.rcp_up[i]);
  }
  begins_ = min(begins_, ray.ray.tmin);
  all_begun_ = max(all_begun_, ray.ray.tmin);
  ends_ = max(ends_, ray.ray.tmax);
  first_end_ = min(first_end_, ray.ray.tmax);
}

/// An axis along which all move down is mirrored, exactly, so that they move up.
PacketSlabs::Stay PacketSlabs::stay(const Axis& axis, float lo, float hi) {
  constexpr Stay kNever{kInfinity, -kInfinity, kInfinity, -kInfinity};
  constexpr Stay kUnknown{-kInfinity, kInfinity, kInfinity, -kInfinity};
  constexpr Stay kAlways{-kInfinity, kInfinity, -kInfinity, kInfinity};
  if (axis.all_still()) {
    if (axis.origin_hi < lo || hi < axis.origin_lo) return kNever;
    return lo <= axis.origin_lo && axis.origin_hi <= hi ? kAlways : kUnknown;
  }
  if (!axis.one_way()) return lo <= hi ? kUnknown : kNever;
  const float near = axis.down ? -hi : lo, far = axis.down ? -lo : hi;
  const float last_origin = axis.down ? -axis.origin_lo : axis.origin_hi;
  const float first_origin = axis.down ? -axis.origin_hi : axis.origin_lo;
  const float rcp_small = axis.down ? -axis.rcp_hi : axis.rcp_lo, rcp_large = axis.down ? -axis.rcp_lo : axis.rcp_hi;
  return {time_of<Round::Down>(numeric::sub<Round::Down>(near, last_origin), rcp_small, rcp_large),
          time_of<Round::Up>(numeric::sub<Round::Up>(far, first_origin), rcp_small, rcp_large),
          time_of<Round::Up>(numeric::sub<Round::Up>(near, first_origin), rcp_small, rcp_large),
          time_of<Round::Down>(numeric::sub<Round::Down>(far, last_origin), rcp_small, rcp_large)};
}

PacketTimes PacketSlabs::test(const intersect::Box4& boxes) const {
  PacketTimes times;
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    float t0 = begins_, t1 = ends_, all_t0 = all_begun_, all_t1 = first_end_;
    for (int i = 0; i < 3; ++i) {
      const Stay within = stay(axis_[i], boxes.lo[i][lane], boxes.hi[i][lane]);
      t0 = max(t0, within.from);
      t1 = min(t1, within.to);
      all_t0 = max(all_t0, within.all_from);
      all_t1 = min(all_t1, within.all_to);
    }
    times.t0[lane] = t0;
    times.hit = static_cast<std::uint8_t>(times.hit | unsigned{t0 <= t1} << lane);
    times.sure = static_cast<std::uint8_t>(times.sure | unsigned{all_t0 <= all_t1} << lane);
  }
  return times;
}

}  // namespace ctu::cull::packet
