// Rays that run through the edges and vertices of closed surfaces, at a place where they must cross: every triangle
// there faces them.
#pragma once

#include <cstdint>
#include <vector>

#include "model/intersect/ray.h"
#include "model/scene/scene.h"
#include "sim/metamorph/closed_parts.h"

namespace ctu::sim::metamorph {

/// A closest-hit ray that reaches what it is aimed at near t = 1, and the t behind which a hit is that of something
/// else: it has gone through there.
struct AimedRay {
  intersect::Ray ray;
  float latest_t = 1;
};

struct AimedRays {
  std::vector<AimedRay> rays;
  std::uint64_t edges = 0, vertices = 0;  ///< that the closed parts have
  std::uint64_t folds = 0;                ///< targets at which no direction faces all triangles; nothing is aimed there
};

/// At the middle and at a random point of every edge, and at every vertex: from outside a few edges away, from outside
/// two sizes of the mesh away (every eighth: 1000 sizes), along an axis where the triangles allow it, and from inside.
/// At most `most` rays (0: all), those of every nth target.
AimedRays aim_at_edges(const scene::Mesh& mesh, const ClosedParts& closed, std::uint64_t seed, std::uint64_t most);

}  // namespace ctu::sim::metamorph
