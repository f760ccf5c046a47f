// The watertight ray/triangle test of Woop, Benthin and Wald (JCGT 2013): shear to ray space, then the signs of
// the three edge functions; both faces are hit.
//
// Numbers between the binary32 inputs and the binary32 results have binary32's 24-bit significand, rounded to
// nearest even, and an exponent wide enough (11 bits) never to leave its range: nothing overflows or underflows,
// so a mesh of size 1e-30 is as watertight as one of size 1. Below, R(x) is one such rounding of an exact value:
//   A, B, C = R(v - origin) of each vertex and axis
//   x       = R(A[kx] - R(sx A[kz]))      y = R(A[ky] - R(sy A[kz]))      of each vertex
//   U       = R(cx by - cy bx)            V = R(ax cy - ay cx)            W = R(bx ay - by ax)
//             one rounding of the difference of two exact 48-bit products: the sign is exact, and zero means zero
//   det     = R(R(U + V) + W)
//   T       = R(R(R(U A[kz]) + R(V B[kz])) + R(W C[kz]))
//   t       = T / R(det d[kz])            u = V / det       v = W / det   one rounding, to binary32 proper
// The paper's third shear constant 1/d[kz] is not needed: dividing by det d[kz] costs one product instead of three
// and does not overflow for subnormal directions.
//
// Limit: x and y are rounded at the size of v - origin, so a ray that passes an edge within a few places of that size
// may be given to the edge's other triangle. In a closed mesh nothing leaks by it; but the box of that other triangle
// may rightly be missed. Measured behind each triangle's own box: 0 of 150,000 aimed rays leak from origins further
// than 1e-5 of the mesh's size from its surface, 1 of 1,000 aimed at lattice edges from closer than that.
#pragma once

#include "model/intersect/ray.h"

namespace ctu::intersect {

struct TriangleResult {
  bool hit = false;
  float t = 0, u = 0, v = 0;
};

/// Hit iff no edge function is negative while another is positive, the determinant is not zero and
/// tmin <= t <= tmax. A ray through a shared edge or vertex hits all triangles that share it. Vertices are finite.
TriangleResult triangle_test(const PreparedRay& ray, const Vec3& v0, const Vec3& v1, const Vec3& v2, float tmax);

}  // namespace ctu::intersect
