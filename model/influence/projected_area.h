// The projected area heuristic (PAH): how likely an affine ray of an influence area visits a box is the share of the
// area's cross-section that the box covers, seen along the rays: projected orthographically along a plane area's
// direction, in perspective from a point area's focal point. The projection of the part of the box between the area's
// two ends is a convex polygon, cut to the cross-section (appendix A.9) and measured (A.10).
#pragma once

#include "model/accel/box3.h"
#include "model/influence/area.h"
#include "model/influence/convex_polygon.h"

namespace ctu::influence {

/// A chance as model/accel/split_heuristic.h has it: 0 to 1, that of a box around the whole area is 1.
class ProjectedArea {
 public:
  /// For boxes in coordinates multiplied by `scale`.
  explicit ProjectedArea(const InfluenceArea& area, double scale = 1);

  float operator()(const accel::Box3& box) const;
  double share(const Vec3& lower, const Vec3& upper) const;

 private:
  struct Corner {
    double x, y, z;
  };
  double share(const float* lower, const float* upper) const;
  Point2 project(const Corner& corner) const;
  ConvexPolygon shadow(const Corner (&corner)[8], double nearest, double farthest) const;

  bool converges_;
  Corner column_[3], origin_;  // local coordinates of the three axes' units, and of the world's origin
  double half_x_, half_y_, near_, far_;
  ConvexPolygon cross_section_;
};

}  // namespace ctu::influence
