// Planes around all rays of a packet, and whether a primitive lies beyond one of them: beyond any plane, it is missed
// by all rays. They say nothing of what lies inside, so there is no all-hit.
//
// The four planes of the frustum are the paper's. Six more, across the coordinate axes, are the sides of the box
// around all rays: where all rays begin and end on a side, or go away from it, nothing beyond it is met. They need no
// major axis, so packets of opposite signs have them too, and they are what closes the frustum at its back.
// Source: section 4 of the packet culling paper.
#pragma once

#include <optional>
#include <span>

#include "model/cull/packet/answer.h"
#include "model/cull/packet/frustum.h"

namespace ctu::cull::packet {

class BoundingPlanes {
 public:
  /// `lines` as of Scale::MajorAxis.
  explicit BoundingPlanes(const Lines& lines);

  Answer test(const Box& box, const Reach& reach = {}) const;
  Answer test(const Triangle& triangle, const Reach& reach = {}) const;
  /// The six vertices (section 4.2.4): beyond one plane at both ends of the motion is beyond it all the time.
  Answer test(const MovingTriangle& triangle, const Reach& reach = {}) const;
  Answer test(const Sphere& sphere, const Reach& reach = {}) const;

  /// Whether the box lies between the four planes and not behind the rays, about: then no test of boxes inside of it
  /// can reject the packet by a plane, and smaller packets do better. A hint, nothing rests on it.
  bool surrounds(const Box& box) const;

 private:
  /// How far beyond the low or high plane of a side the points may be, in units along the side's axis; negative is
  /// between the planes. Each point may lie anywhere in its intervals.
  struct Beyond {
    Interval low, high;
  };
  Beyond beyond(const FrustumSide& side, const IntervalVector& place) const;
  bool all_beyond(std::span<const IntervalVector> points, const Reach& reach) const;
  Answer test_points(std::span<const Vec3> points, const Reach& reach) const;

  Vec3 reference_;
  int axis_;
  bool backward_;
  std::optional<Frustum> frustum_;
  IntervalVector around_;  ///< the box around all rays
};

}  // namespace ctu::cull::packet
