// The slab test of a whole packet, in the rays' own t: what a unit keeps of a packet, gathered ray by ray, and the box
// test of four children that it allows.
//
// Every number is an outer bound of what intersect::slab_test computes for each ray by itself, and directed rounding is
// monotone; so a child that is missed here is missed, to the bit, by slab_test of every ray, and t0 here is not after
// t0 there. Along an axis on which not all rays move in one direction nothing is known of the times, but where none
// moves the origins say whether all are outside.
// Source: equation 1 of the packet culling paper, T_x = (B_x - O_x) (1 / V_x), in the shape of slab_test.h.
#pragma once

#include <limits>

#include "model/intersect/slab_test.h"

namespace ctu::cull::packet {

/// Of the lanes that some ray may meet: bits, and not after the first meeting of any ray.
struct PacketTimes {
  std::uint8_t hit = 0;
  float t0[intersect::kLanes] = {};
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
  /// The times between which some ray may be within the slab.
  struct Stay {
    float from, to;
  };
  static Stay stay(const Axis& axis, float lo, float hi);

  Axis axis_[3];
  float begins_ = kInfinity, ends_ = -kInfinity;
};

}  // namespace ctu::cull::packet
