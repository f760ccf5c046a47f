// Where a ray meets a closed triangle in exact arithmetic, whatever the triangle's shape.
#pragma once

#include "model/intersect/ray.h"
#include "tests/oracle/exact_box.h"

namespace ctu::oracle {

struct ExactTriangleHit {
  bool hit = false;      ///< some t in [tmin, tmax] lies in the closed triangle, its edges and vertices included
  bool edge_on = false;  ///< the ray lies in the triangle's plane, or the triangle has no area
  ExactTime t;           ///< the first such t
  double nearest_t = 0;  ///< the same, to binary64
  double u = 0, v = 0;   ///< the point is (1-u-v) v0 + u v1 + v v2; not given where edge_on
  bool on_edge = false;  ///< the point lies on an edge or vertex; not given where edge_on
};

ExactTriangleHit exact_ray_triangle(const intersect::Ray& ray, const Vec3& v0, const Vec3& v1, const Vec3& v2,
                                    float tmin, float tmax);

/// The sign (-1, 0, +1) of a b - c d.
int exact_sign_of_difference(double a, double b, double c, double d);

}  // namespace ctu::oracle
