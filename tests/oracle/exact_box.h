// Where a ray meets planes and boxes in exact arithmetic. Exact times are given as the two binary32 numbers that
// enclose them most tightly: a bound b is at or below the exact time iff b <= down, at or above it iff b >= up.
#pragma once

#include "model/intersect/ray.h"

namespace ctu::oracle {

struct ExactTime {
  float down = 0, up = 0;
};

/// The t at which the ray crosses the plane x[axis] = plane; the direction component is not zero.
ExactTime exact_plane_time(const intersect::Ray& ray, int axis, float plane);

struct ExactBoxSpan {
  bool hit = false;       ///< some t in [tmin, tmax] lies in the closed box
  ExactTime entry, exit;  ///< the first and the last such t; meaningful where hit
};
ExactBoxSpan exact_box_span(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, float tmin, float tmax);

bool exact_ray_hits_box(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, float tmin, float tmax);

}  // namespace ctu::oracle
