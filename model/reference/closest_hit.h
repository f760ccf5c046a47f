// The untimed, uncounted way to a ray's hit: for making rays and for holding other answers against.
//
// It answers what testing every primitive with intersect::triangle_test or sphere_test and keeping the best by
// intersect::replaces() would answer, bit for bit: its boxes are padded by more than the triangle test's own rounding,
// so that not even a triangle which is hit by rounding alone is skipped (padded_boxes.h). The reference traversal,
// whose boxes are exact, may rightly skip such a near miss.
#pragma once

#include <vector>

#include "model/accel/bvh4.h"
#include "model/intersect/ray.h"
#include "model/reference/fast_triangle.h"
#include "model/reference/node8.h"

namespace ctu::reference {

class FastTracer {
 public:
  /// Keeps nothing of `bvh` itself. Throws Error when it is deeper than any tree the builder makes.
  explicit FastTracer(const accel::Bvh4& bvh);

  /// The nearest hit in [tmin, tmax]; for a ray that is not valid, a miss. `ray.kind` plays no part.
  intersect::Hit closest(const intersect::Ray& ray) const;

  /// Whether any triangle is hit in [tmin, tmax].
  bool occluded(const intersect::Ray& ray) const;

 private:
  template <bool kAny>
  intersect::Hit trace(const intersect::Ray& ray) const;
  template <bool kAny, class Boxes, class Triangle>
  intersect::Hit walk(const intersect::Ray& ray, const Boxes& boxes, const Triangle& triangle) const;

  template <bool kAny, class Boxes, class Triangle>
  intersect::Hit walk_leaves_of(const intersect::Ray& ray, const Boxes& boxes, const Triangle& triangle) const;

  Vec3 lower_, upper_;  // bounds of all vertices and spheres
  bool has_spheres_;
  std::vector<Node8> nodes_;
  std::vector<VertexRows> rows_;  // of the triangles, in leaf order
};

}  // namespace ctu::reference
