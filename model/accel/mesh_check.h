// What a mesh must be before boxes are made of it.
#pragma once

#include "model/accel/box3.h"
#include "model/scene/scene.h"

namespace ctu::accel {

/// The bounds of the triangles. Throws ctu::Error, naming the triangle, when a corner is missing or not finite.
Box3 checked_bounds(const scene::Mesh& mesh, int threads);

}  // namespace ctu::accel
