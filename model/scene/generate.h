// Scenes made by formula, for tests, demonstrations and sweeps: "gen:NAME?key=value&key=value".
//
//   hair-ball      straight strands on a ball     strands=2000 segments=8 radius=1 length=1 spread=0.15 thickness=0.002
//   curly-hair     helical strands on a ball      strands=2000 segments=32 radius=1 length=1 curls=4 curl-radius=0.05
//                                                 thickness=0.002
//   straight-hair  near-parallel strands on a     strands=2000 segments=8 length=2 tilt=35 spread=0.05 thickness=0.002
//                  square, tilted by degrees
//   tilted-quads   random quads turned every way  quads=2000 size=0.1 aspect=8
//   foliage        twigs of cards in a crown      twigs=200 cards=12 size=0.06 aspect=2.5
//   tetra          SPD's recursive tetrahedron    depth=6 (4^depth triangles)
//   balls          SPD's sphereflake on a square  depth=4 (1 + 9 + ... + 9^depth spheres, 7,381; 2 triangles)
//
// All but tetra and balls take seed=1. Random numbers come from a counter-based generator and no function of libm but
// sqrt is used, so the same name gives the same bits everywhere. Lengths are in scene units; the scenes are a few units
// wide.
#pragma once

#include <string>

#include "model/scene/draft.h"

namespace ctu::scene {

inline constexpr const char* kGeneratorPrefix = "gen:";

/// Appends the scene that `name` (with its "gen:") describes. Throws Error for an unknown name, key or value, naming
/// the nearest known one.
void generate(const std::string& name, Draft& draft);

}  // namespace ctu::scene
