// Where a ray meets a sphere in exact arithmetic: signs of the quadratic and of its slope, no square root.
#pragma once

#include "model/intersect/ray.h"
#include "tests/oracle/exact_box.h"

namespace ctu::oracle {

struct ExactSphereHit {
  bool hit = false;  ///< some t in [tmin, tmax] lies on the surface
  ExactTime t;       ///< the first such t; meaningful where hit
};

/// A radius of 0 is a point; of a negative one the magnitude counts.
ExactSphereHit exact_ray_sphere(const intersect::Ray& ray, const Vec3& centre, float radius, float tmin, float tmax);

}  // namespace ctu::oracle
