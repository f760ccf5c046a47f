// Influence areas: the regions where next-event estimation bends the rays one way (the ray-distribution paper, Fig. 5).
// Around a planar light rays run parallel, in an oriented box; around a point light they converge, in a frustum whose
// sides meet in the focal point.
//
// An area is what its binary32 numbers say in exact arithmetic: with q = axes (p - origin), the closed body
//   near <= q.z <= far,   |q.x| <= half_x s,   |q.y| <= half_y s,    s = 1 in a plane area, q.z in a point area.
// In these local coordinates its corners are exact products. Axes need not be orthonormal to the last bit.
#pragma once

#include <array>
#include <cstdint>

#include "model/influence/separating_axis.h"
#include "model/intersect/ray.h"

namespace ctu::influence {

enum class AreaKind : std::uint8_t { Plane, Point };
const char* to_string(AreaKind kind);

struct InfluenceArea {
  AreaKind kind = AreaKind::Plane;
  Vec3 origin;                   ///< of local coordinates; the focal point of a point area
  std::array<Vec3, 3> axes;      ///< the third runs along the rays, away from the light in a point area
  float half_x = 0, half_y = 0;  ///< half the width of the cross-section; in a point area at distance 1
  float near = 0, far = 0;       ///< along the third axis; a point area's are not negative
};

/// What is wrong with an area whose numbers are not all finite, whose axes do not span space, which has a negative
/// width or ends before it begins, or, a point area, begins behind its focal point. Null for one that is right.
const char* problem_of(const InfluenceArea& area);

/// Three perpendicular unit vectors to binary32, the third along `direction` (not zero), the first as near as possible
/// to `across`.
std::array<Vec3, 3> frame_along(const Vec3& direction, const Vec3& across);

/// An area ready to be asked.
class PreparedArea {
 public:
  /// Throws Error when there is a problem_of() it.
  explicit PreparedArea(const InfluenceArea& area);

  const InfluenceArea& area() const { return area_; }
  /// The body in local coordinates.
  const ConvexBody& body() const { return body_; }

  BoundedPoint to_local(const Vec3& point) const;
  BoundedPoint direction_to_local(const Vec3& direction) const;

  /// Whether the point lies in the area whatever was rounded. False for points within rounding of its border.
  bool certainly_contains(const BoundedPoint& local) const;
  bool certainly_contains(const Vec3& point) const { return certainly_contains(to_local(point)); }
  /// ... the exact point of the ray at `t`, which must be finite.
  bool certainly_contains(const intersect::Ray& ray, float t) const;
  /// ... the whole box.
  bool certainly_contains(const Vec3& lower, const Vec3& upper) const;

  /// Whether triangle or box may have a point in the area: never false when one has. A centre inside would not do: a
  /// hit inside may lie on a triangle that is mostly outside.
  bool may_touch(const Vec3& v0, const Vec3& v1, const Vec3& v2) const;
  bool may_touch(const Vec3& lower, const Vec3& upper) const;

 private:
  InfluenceArea area_;
  ConvexBody body_;
};

}  // namespace ctu::influence
