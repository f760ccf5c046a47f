// A ray as the unit receives it, and the constants the unit derives from it once (a context's registers).
#pragma once

#include <cstdint>

#include "model/numeric/vec3.h"

namespace ctu::intersect {

enum class RayKind : std::uint8_t { ClosestHit = 0, AnyHit = 1 };

/// Points origin + t * direction with t in [tmin, tmax]; the direction need not have length 1.
struct Ray {
  Vec3 origin;
  float tmin = 0;
  Vec3 direction;
  float tmax = 0;
  RayKind kind = RayKind::ClosestHit;
};

/// Whether the unit accepts the ray: origin, direction and tmin finite, direction not zero, tmax not NaN,
/// tmin <= tmax. A ray that is not accepted is a miss that visits nothing.
bool is_valid(const Ray& ray);

inline constexpr std::uint32_t kNoPrimitive = 0xFFFFFFFFu;

/// What a ray found: `primitive` is kNoPrimitive and t the ray's tmax when it found nothing.
/// The point is (1-u-v) v0 + u v1 + v v2 of a triangle; u and v of a sphere are 0.
struct Hit {
  float t = 0, u = 0, v = 0;
  std::uint32_t primitive = kNoPrimitive;
  bool operator==(const Hit&) const = default;  // note: bit equality is same_bits()
};
bool same_bits(const Hit& a, const Hit& b);

/// The rule of hit_update: nearer wins, equal t goes to the lower primitive id, so that the order in
/// which triangles are met does not matter.
inline bool replaces(float t, std::uint32_t primitive, const Hit& best) {
  return t < best.t || (t == best.t && primitive < best.primitive);
}

/// Derived once per ray: enclosing reciprocals of the direction, and the shear of the watertight
/// triangle test (Woop, Benthin, Wald 2013, section 3.1).
struct PreparedRay {
  Ray ray;
  Vec3 rcp_down, rcp_up;                ///< rcp_down <= 1/d <= rcp_up; unused where d is zero
  std::uint8_t zero_axes = 0;           ///< bit a: direction[a] is +0 or -0
  std::uint8_t negative_axes = 0;       ///< bit a: direction[a] < 0
  std::uint8_t kx = 0, ky = 1, kz = 2;  ///< axes after the permutation; kz has the largest |d|
  float sx = 0, sy = 0;                 ///< shear constants dx/dz, dy/dz, rounded to nearest
  bool valid = false;
};
PreparedRay prepare_ray(const Ray& ray);

}  // namespace ctu::intersect
