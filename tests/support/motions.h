// Ways to move a mesh's vertices, for tests of what is refitted.
#pragma once

#include <cstdint>
#include <string>

#include "model/scene/scene.h"

namespace ctu::test {

enum class Motion {
  Nothing,
  OneVertex,   ///< by up to a tenth of the mesh
  Dent,        ///< the vertices nearest to one of them, about 1 %, towards the middle
  Scattered,   ///< about 5 %, each on its own
  Twist,       ///< all, about the z axis
  Degenerate,  ///< about 3 % of the triangles become points, about 3 % lines
  Flatten,     ///< all into a plane
  FarAway,     ///< one vertex to 1e30, so that nearly everything lies in one cell
  Reorder,     ///< about 10 % of the vertices swap places
  Signs,       ///< all to where they are, but zeros of coordinates have the other sign
};
inline constexpr Motion kMotions[] = {Motion::Nothing, Motion::OneVertex,  Motion::Dent,    Motion::Scattered,
                                      Motion::Twist,   Motion::Degenerate, Motion::Flatten, Motion::FarAway,
                                      Motion::Reorder, Motion::Signs};
std::string to_string(Motion motion);

/// The same triangles over moved vertices; the same for the same seed.
scene::Mesh moved(scene::Mesh mesh, Motion motion, std::uint64_t seed);

}  // namespace ctu::test
