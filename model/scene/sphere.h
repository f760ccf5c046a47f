// A sphere as a primitive: the surface of a ball.
#pragma once

#include "model/numeric/round.h"
#include "model/numeric/vec3.h"

namespace ctu::scene {

struct Sphere {
  Vec3 centre;
  float radius = 0;  ///< 0 or more; 0 is a point
  bool operator==(const Sphere&) const = default;
};

/// The smallest box of binary32 numbers around the sphere: each plane is rounded outward once. An overflow gives an
/// infinity, which the loader refuses.
inline Vec3 lower_corner(const Sphere& s) {
  using numeric::Round;
  return {numeric::sub<Round::Down>(s.centre.x, s.radius), numeric::sub<Round::Down>(s.centre.y, s.radius),
          numeric::sub<Round::Down>(s.centre.z, s.radius)};
}
inline Vec3 upper_corner(const Sphere& s) {
  using numeric::Round;
  return {numeric::add<Round::Up>(s.centre.x, s.radius), numeric::add<Round::Up>(s.centre.y, s.radius),
          numeric::add<Round::Up>(s.centre.z, s.radius)};
}

}  // namespace ctu::scene
