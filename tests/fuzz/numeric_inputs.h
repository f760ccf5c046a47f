// Any bits as numbers, rays, boxes and triangles: the arithmetic core against exact rationals.
#pragma once

#include "tests/fuzz/harness.h"

namespace ctu::fuzz {

/// Every ten bytes are an operation, a rounding and two operands.
void check_operations(Input input);

/// Every record is a ray, a box and a resolution: enclosing times, the same bits of every form of the slab test, and
/// every cell that the ray touches in every design that finds cells.
void check_boxes(Input input);

/// Every record is a ray and a triangle: the stated bits, and no design rejects the box of a triangle that the ray
/// meets.
void check_triangles(Input input);

}  // namespace ctu::fuzz
