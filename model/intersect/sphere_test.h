// The ray/sphere test: from the point of the line nearest to the centre, and half the chord from there, as Haines,
// Guenther and Akenine-Moeller recommend ("Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019,
// chapter 7): a sphere far off or much larger than the ray's unit does not dissolve into noise.
//
// Numbers between the binary32 inputs and the binary32 result are those of round24.h: nothing overflows or underflows.
// With R(x) one rounding of an exact value, to nearest even:
//   f      = R(o - c) on each axis        dot(p, q) = R(R(R(px qx) + R(py qy)) + R(pz qz))
//   a      = dot(d, d)                    s = -R(dot(f, d) / a): t of the nearest point
//   l      = R(f + R(s d)) on each axis   m = dot(l, l): how far that point is from the centre, squared
//   delta  = R(R(r r) - m)                h = R(sqrt(R(delta / a))): half the chord in t
//   t      = R(s - h), else R(s + h)      and then to binary32 proper; a zero is +0
//
// Errors, u = 2^-24, to first order: s |d| is off by 8 u |f| and l by 11 u |f|, so the test decides wrongly only about
// rays whose line passes within 12 u |f| + 2 u r of the silhouette. h |d| is off by 4 u r and t by the roundings of
// both, so the ray's point at t lies within 24 u |f| + 8 u r of the sphere.
#pragma once

#include "model/intersect/ray.h"
#include "model/scene/sphere.h"

namespace ctu::intersect {

struct SphereResult {
  bool hit = false;
  float t = 0;
};

/// Hit iff delta is not negative and the first of these two t that is not before tmin is at most tmax. Both sides of
/// the surface are hit; the inside of the ball is not part of it. The sphere is finite; a radius of 0 is a point.
SphereResult sphere_test(const PreparedRay& ray, const scene::Sphere& sphere, float tmax);

}  // namespace ctu::intersect
