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

/// The projected area with a part of the surface area. Where sibling boxes cover each other for the rays, every cut has
/// the same projected cost, and PAH alone takes any: it peels off a few triangles and the tree leans. There the surface
/// area decides; and for the rays that are not quite affine it counts what PAH thinks free, a box seen edge-on.
class MixedArea {
 public:
  /// `part` of the surface area, 0 to 1, where the tree's box has `root_half_area` in scaled coordinates.
  MixedArea(const ProjectedArea& projected, double part, double root_half_area)
      : projected_(projected),
        projected_part_(static_cast<float>(1 - part)),
        surface_part_(root_half_area > 0 ? static_cast<float>(part / root_half_area) : 0) {}

  float operator()(const accel::Box3& box) const {
    return projected_part_ * projected_(box) + surface_part_ * accel::half_area(box);
  }

 private:
  ProjectedArea projected_;
  float projected_part_, surface_part_;
};

}  // namespace ctu::influence
