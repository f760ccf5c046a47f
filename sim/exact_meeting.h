// Whether a ray exactly meets what packet culling asks about, as the oracle says.
#pragma once

#include "model/cull/packet/answer.h"
#include "tests/oracle/ray_oracle.h"

namespace ctu::sim {

inline bool meets(oracle::RayOracle& ray, const cull::packet::Box& box) { return ray.meets_box(box.lo, box.hi); }
inline bool meets(oracle::RayOracle& ray, const cull::packet::Triangle& t) {
  return ray.meets_triangle(t.vertex[0], t.vertex[1], t.vertex[2]);
}
inline bool meets(oracle::RayOracle& ray, const cull::packet::Sphere& sphere) {
  return ray.meets_sphere(sphere.centre, sphere.radius);
}

}  // namespace ctu::sim
