// Loop subdivision: a control mesh of triangles to the smooth surface that it stands for.
// Source: Loop, "Smooth subdivision surfaces based on triangles", thesis, Utah 1987; the weights of extraordinary
// vertices and of boundaries are those of pbrt (Pharr and Humphreys, section 3.8), whose files name such surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/scene/place.h"
#include "model/scene/vector64.h"

namespace ctu::scene {

struct ControlMesh {
  std::vector<Vector64> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// One level: every triangle becomes four, every edge a vertex. An inner vertex of n neighbours keeps 1 - n b of itself
/// and takes b of each, b = 3/16 for n = 3 and 3/(8n) otherwise; one on the boundary takes 1/8 of each of its
/// neighbours on the boundary. The vertex of an inner edge is 3/8 of its ends and 1/8 of the two corners across, of a
/// boundary edge its middle. A vertex that no triangle has stays. Throws Error at `where` for an edge of more than two
/// triangles and for a triangle with a corner twice. In binary64, to nearest.
ControlMesh subdivide_loop(const ControlMesh& mesh, const Place& where);

/// The same triangles with each vertex where endless subdivision would bring it: 1/(n + 3/(8b)) of each neighbour, on
/// the boundary, a cubic B-spline, 1/6 of each neighbour there (pbrt takes 1/5, which is not the limit of its own
/// rule).
ControlMesh on_limit_surface(const ControlMesh& mesh, const Place& where);

}  // namespace ctu::scene
