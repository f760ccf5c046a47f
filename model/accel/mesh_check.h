// What a mesh must be before boxes are made of it.
#pragma once

#include "model/accel/box3.h"
#include "model/scene/scene.h"

namespace ctu::accel {

/// The bounds of triangles and spheres. Throws ctu::Error, naming it, when a corner of a triangle is missing or not
/// finite, or a sphere is not finite.
Box3 checked_bounds(const scene::Mesh& mesh, int threads);

}  // namespace ctu::accel
