// A primitive of a leaf against the best hit so far.
#pragma once

#include "model/accel/bvh4.h"
#include "model/intersect/sphere_test.h"
#include "model/intersect/triangle_test.h"

namespace ctu::reference {

/// Whether the primitive became the best hit. `kSpheres`: whether it may be a sphere.
template <bool kSpheres>
bool test_primitive(const intersect::PreparedRay& ray, const accel::LeafTriangle& primitive, intersect::Hit& best) {
  if constexpr (kSpheres) {
    if (primitive.is_sphere()) {
      const intersect::SphereResult result = intersect::sphere_test(ray, primitive.sphere(), best.t);
      if (!result.hit || !intersect::replaces(result.t, primitive.id(), best)) return false;
      best = {result.t, 0, 0, primitive.id()};
      return true;
    }
  }
  const auto result = intersect::triangle_test(ray, primitive.v0, primitive.v1, primitive.v2, best.t);
  if (!result.hit || !intersect::replaces(result.t, primitive.primitive, best)) return false;
  best = {result.t, result.u, result.v, primitive.primitive};
  return true;
}

}  // namespace ctu::reference
