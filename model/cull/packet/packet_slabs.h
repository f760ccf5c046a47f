// The slab test of a whole packet, in the rays' own t: what a unit keeps of a packet, gathered ray by ray, and the box
// test of four children that it allows.
//
// Every number is an outer bound of what intersect::slab_test computes for each ray by itself, and directed rounding is
// monotone; so a child that is missed here is missed, to the bit, by slab_test of every ray, and t0 here is not after
// t0 there. Inner bounds say the same of what is met: a child that is surely met here is hit, to the bit, by slab_test
// of every ray. Along an axis on which not all rays move in one direction nothing is known of the times, but where none
// moves the origins say whether all are outside, or inside.
// Source: equation 1 of the packet culling paper, T_x = (B_x - O_x) (1 / V_x), in the shape of slab_test.h.
#pragma once

#include <limits>

#include "model/intersect/slab_test.h"

namespace ctu::cull::packet {

/// Of four lanes.
struct PacketTimes {
  std::uint8_t hit = 0;              ///< bit lane: some ray may meet the box
  std::uint8_t sure = 0;             ///< bit lane: every ray meets it, by its own slab test
  float t0[intersect::kLanes] = {};  ///< of lanes hit: not after the first meeting of any ray
};

class PacketSlabs {
 public:
  /// `ray` must be valid.
  void add(const intersect::PreparedRay& ray);

  bool empty() const { return axis_[0].nobody(); }
  /// Where the first ray begins.
  float begins() const { return begins_; }

  /// Empty lanes (lo = +inf, hi = -inf) are missed. There must be a ray.
  PacketTimes test(const intersect::Box4& boxes) const;

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  struct Axis {
    float origin_lo = kInfinity, origin_hi = -kInfinity;
    float rcp_lo = kInfinity, rcp_hi = -kInfinity;  ///< of the rays that move
    bool up = false, down = false, still = false;   ///< some ray moves so

    bool nobody() const { return !up && !down && !still; }
    bool one_way() const { return up != down && !still; }
    bool all_still() const { return still && !up && !down; }
  };
  /// Some ray may be within the slab between `from` and `to`; every ray is between `all_from` and `all_to`.
  struct Stay {
    float from, to, all_from, all_to;
  };
  static Stay stay(const Axis& axis, float lo, float hi);

  Axis axis_[3];
  float begins_ = kInfinity, ends_ = -kInfinity;          ///< the first begin, the last end
  float all_begun_ = -kInfinity, first_end_ = kInfinity;  ///< the last begin, the first end
};

}  // namespace ctu::cull::packet
