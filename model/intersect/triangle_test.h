// The watertight ray/triangle test of Woop, Benthin and Wald (JCGT 2013), in binary32 round-to-nearest, the signs
// of the three edge functions exact (a comparison of two 48-bit products), both faces hit.
#pragma once

#include "model/intersect/ray.h"

namespace ctu::intersect {

struct TriangleResult {
  bool hit = false;
  float t = 0, u = 0, v = 0;
};

/// Hit iff the edge functions agree in sign, the determinant is not zero and tmin <= t <= tmax.
TriangleResult triangle_test(const PreparedRay& ray, const Vec3& v0, const Vec3& v1, const Vec3& v2, float tmax);

}  // namespace ctu::intersect
