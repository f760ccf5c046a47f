// The volume between four planes that a packet with a major axis stays in: a rectangle across the axis that moves
// along it, each of its sides at a speed of its own. Both geometric methods are made from it: its sides are the
// bounding planes, its corners the corner rays.
//
// Coordinates are *forward*, along the major axis the way the rays go, and the other two axes, all relative to the
// packet's reference. Dividing slopes by |d_k| instead of d_k is what section 4.1.3 of the packet culling paper does
// by flipping the normals of packets that go backward.
// Source: section 4.1 of the packet culling paper (major axis, slopes, plane origins).
#pragma once

#include <optional>

#include "model/cull/packet/lines.h"

namespace ctu::cull::packet {

/// At forward coordinate f >= back, every ray that has begun lies within low + low_slope (f - back) and
/// high + high_slope (f - back): the four numbers are binary32, so the volume is exactly what they say.
struct FrustumSide {
  int axis = 0;
  float low = 0, high = 0;
  float low_slope = 0, high_slope = 0;
};

struct Frustum {
  FrustumSide side[2];
  float back = 0;       ///< forward coordinate at or before every ray's begin
  float front = 0;      ///< at or beyond every ray's end; may be +inf
  float all_begun = 0;  ///< at or beyond every ray's begin
  float first_end = 0;  ///< at or before every ray's end
};

/// `lines` as of Scale::MajorAxis. Nothing without a major axis, or where a slope or a place is beyond binary32.
std::optional<Frustum> make_frustum(const Lines& lines);

}  // namespace ctu::cull::packet
