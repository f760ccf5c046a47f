// What a ray meets, decided exactly and almost always fast: by binary64 with a bound on its rounding error, where that
// leaves a doubt by the exact sign of the same sums (exact_sum.h), and by rationals in the few cases left (a ray in a
// triangle's plane, a triangle without area, a sphere that is barely touched).
//
// The bounds: with u = 2^-53, a sum of products of n rounded factors and k roundings on the way is off by at most
// (n + k) u times the same sum of magnitudes, to first order. Nothing here has more than 12 of them, and magnitudes
// are summed with the same few roundings, so 16 u is enough. Products of up to four binary32 numbers or of their
// differences stay within 2^-596 .. 2^516: binary64 neither overflows nor underflows.
#pragma once

#include <cstdint>

#include "model/intersect/ray.h"

namespace ctu::oracle {

struct OracleCounts {
  std::uint64_t asked = 0;
  std::uint64_t summed = 0;    ///< ... of these, binary64 left a doubt
  std::uint64_t rational = 0;  ///< ... and these went on to rationals
  OracleCounts& operator+=(const OracleCounts& other) {
    asked += other.asked;
    summed += other.summed;
    rational += other.rational;
    return *this;
  }
};

class RayOracle {
 public:
  /// The ray must be valid.
  explicit RayOracle(const intersect::Ray& ray);

  /// Whether some t in [tmin, tmax] lies in the closed triangle, of any shape: what exact_ray_triangle says.
  bool meets_triangle(const Vec3& v0, const Vec3& v1, const Vec3& v2);
  /// ... in the closed box: what exact_ray_hits_box says.
  bool meets_box(const Vec3& lo, const Vec3& hi);
  /// ... on the surface of the sphere: what exact_ray_sphere says.
  bool meets_sphere(const Vec3& centre, float radius);

  const OracleCounts& counts() const { return counts_; }

 private:
  struct Vector {
    double x, y, z;
  };
  Vector from_origin(const Vec3& point) const;
  bool box_of_triangle_is_met(const Vec3 (&v)[3]) const;
  /// -1: missed, +1: met, else binary64 cannot tell.
  int box_sign(const Vec3& lo, const Vec3& hi) const;
  int sphere_sign(const Vec3& centre, float radius) const;
  /// What is left of the question after box_sign.
  bool box_by_sums(const Vec3& lo, const Vec3& hi) const;

  intersect::Ray ray_;
  Vector origin_, direction_;
  double tmin_, tmax_;
  bool bounded_;  ///< tmax is finite
  OracleCounts counts_;
};

}  // namespace ctu::oracle
