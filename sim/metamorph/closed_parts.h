// The parts of a mesh that are closed: nothing gets from one side to the other but through a triangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/scene/scene.h"

namespace ctu::sim::metamorph {

/// Triangles of all closed parts, wound so that their normals point out of what they enclose.
struct ClosedParts {
  std::uint64_t parts = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices of the mesh, the first of those at one place
};

/// Vertices at one place are one vertex; triangles with two corners at one place are left out. A part is what hangs
/// together by edges; it is closed when each of its edges belongs to exactly two triangles, which can be wound so that
/// they run along it in opposite directions.
ClosedParts closed_parts(const scene::Mesh& mesh);

}  // namespace ctu::sim::metamorph
