// The box of one primitive: what ray-box culling asks before it tests the primitive itself.
#pragma once

#include "model/accel/bvh4.h"

namespace ctu::accel {

/// A box around a primitive, or around what of it lies in a leaf: 24 bytes.
struct PrimitiveBox {
  Vec3 lower, upper;
  bool operator==(const PrimitiveBox&) const = default;
};
static_assert(sizeof(PrimitiveBox) == 24);

/// Exact for a triangle, rounded outward for a sphere.
PrimitiveBox box_of_primitive(const LeafTriangle& primitive);

}  // namespace ctu::accel
