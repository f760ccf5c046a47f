#include "model/influence/projected_area.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ctu::influence {
namespace {

/// Perspective ends here: what is nearer to the focal point than this share of the area's length covers everything.
constexpr double kNearestShare = 1e-6;

constexpr int kEdges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                               {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};

/// The area of the shadow of a box without its outline: faces turned to the light cover it once, the others once more.
double shadow_area(const Point2 (&p)[8]) {
  double both = 0;
  for (const auto& [a, b, c, d] : kFaces)
    both += std::fabs((p[c].x - p[a].x) * (p[d].y - p[b].y) - (p[d].x - p[b].x) * (p[c].y - p[a].y));
  return 0.25 * both;
}

bool fits(std::span<const Point2> points, double half_x, double half_y) {
  for (const Point2& p : points)
    if (std::fabs(p.x) > half_x || std::fabs(p.y) > half_y) return false;
  return true;
}

}  // namespace

ProjectedArea::ProjectedArea(const InfluenceArea& area, double scale) : converges_(area.kind == AreaKind::Point) {
  for (int i = 0; i < 3; ++i) column_[i] = {area.axes[0][i] / scale, area.axes[1][i] / scale, area.axes[2][i] / scale};
  const auto along = [&](const Vec3& axis) {
    const Vec3& o = area.origin;
    return -(double(axis.x) * o.x + double(axis.y) * o.y + double(axis.z) * o.z);
  };
  origin_ = {along(area.axes[0]), along(area.axes[1]), along(area.axes[2])};
  constexpr double kThinnest = std::numeric_limits<float>::min();  // a cross-section without area has no shares
  half_x_ = std::max<double>(area.half_x, kThinnest);
  half_y_ = std::max<double>(area.half_y, kThinnest);
  near_ = converges_ ? std::max<double>(area.near, area.far * kNearestShare) : area.near;
  far_ = area.far;
  cross_section_ = rectangle(half_x_, half_y_);
}

Point2 ProjectedArea::project(const Corner& c) const {
  return converges_ ? Point2{c.x / c.z, c.y / c.z} : Point2{c.x, c.y};
}

/// Of the part of the box between the ends of the area.
ConvexPolygon ProjectedArea::shadow(const Corner (&corner)[8], double nearest, double farthest) const {
  Point2 points[8 + 2 * 12];
  std::size_t count = 0;
  for (const Corner& c : corner)
    if (c.z >= near_ && c.z <= far_) points[count++] = project(c);
  for (const double end : {near_, far_}) {
    if (nearest >= end || farthest <= end) continue;
    for (const auto& [i, j] : kEdges) {
      const Corner &a = corner[i], &b = corner[j];
      if ((a.z < end) == (b.z < end)) continue;
      const double share = (end - a.z) / (b.z - a.z);
      points[count++] = project({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), end});
    }
  }
  return convex_hull({points, count});
}

double ProjectedArea::share(const float* lower, const float* upper) const {
  Corner corner[8];
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (int i = 0; i < 8; ++i) {
    const double x = (i & 1) != 0 ? upper[0] : lower[0], y = (i & 2) != 0 ? upper[1] : lower[1],
                 z = (i & 4) != 0 ? upper[2] : lower[2];
    corner[i] = {origin_.x + column_[0].x * x + column_[1].x * y + column_[2].x * z,
                 origin_.y + column_[0].y * x + column_[1].y * y + column_[2].y * z,
                 origin_.z + column_[0].z * x + column_[1].z * y + column_[2].z * z};
    nearest = std::min(nearest, corner[i].z);
    farthest = std::max(farthest, corner[i].z);
  }
  if (farthest < near_ || nearest > far_) return 0;
  const double whole = 4 * half_x_ * half_y_;
  if (nearest >= near_ && farthest <= far_) {
    Point2 points[8];
    for (int i = 0; i < 8; ++i) points[i] = project(corner[i]);
    if (fits(points, half_x_, half_y_)) return shadow_area(points) / whole;
  }
  const ConvexPolygon polygon = shadow(corner, nearest, farthest);
  return area(overlap(polygon, cross_section_)) / whole;
}

double ProjectedArea::share(const Vec3& lower, const Vec3& upper) const {
  const float from[3] = {lower.x, lower.y, lower.z}, to[3] = {upper.x, upper.y, upper.z};
  return share(from, to);
}

float ProjectedArea::operator()(const accel::Box3& box) const {
  alignas(16) float lower[4], upper[4];
  _mm_store_ps(lower, box.lower);
  _mm_store_ps(upper, box.upper);
  return static_cast<float>(share(lower, upper));
}

}  // namespace ctu::influence
