// What every traversal must find: each primitive of the mesh tested by itself, the best hit kept.
#pragma once

#include "model/accel/leaf_record.h"
#include "model/intersect/sphere_test.h"
#include "model/intersect/triangle_test.h"

namespace ctu::test {

/// By triangle_test, sphere_test and replaces() alone; no hit for a ray that is not valid.
inline intersect::Hit brute_force(const scene::Mesh& mesh, const intersect::Ray& ray) {
  intersect::Hit best{ray.tmax, 0, 0, intersect::kNoPrimitive};
  const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
  if (!prepared.valid) return best;
  for (std::uint32_t id = 0; id < mesh.primitives(); ++id) {
    const accel::LeafTriangle p = accel::leaf_record(mesh, id);
    intersect::TriangleResult r;
    if (p.is_sphere()) {
      const auto s = intersect::sphere_test(prepared, p.sphere(), best.t);
      r = {s.hit, s.t, 0, 0};
    } else {
      r = intersect::triangle_test(prepared, p.v0, p.v1, p.v2, best.t);
    }
    if (r.hit && intersect::replaces(r.t, id, best)) best = {r.t, r.u, r.v, id};
  }
  return best;
}

}  // namespace ctu::test
