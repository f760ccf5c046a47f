// Rays that get through a closed surface: no hit where exact arithmetic says that they cross it.
#pragma once

#include <cstdint>
#include <vector>

#include "model/scene/scene.h"
#include "sim/metamorph/aimed_rays.h"
#include "sim/metamorph/hit_changes.h"
#include "sim/metamorph/world.h"

namespace ctu::sim::metamorph {

struct Leaks {
  std::uint64_t leaks = 0;  ///< summed over designs, None and all triangles without a tree included
  /// Rays that only ideal culling lets through: the rounded triangle test gives them to a neighbour of the triangle
  /// that they meet, which they exactly miss, and ideal culling, which does not round, rightly leaves that one out. The
  /// designs of the unit may do so as well; theirs are leaks.
  std::uint64_t declined = 0;
  /// Rays that find nothing up to latest_t where exact arithmetic finds nothing either: rounding has moved them past
  /// what they were aimed at.
  std::uint64_t passed_by = 0;
};

Leaks find_leaks(const scene::Mesh& mesh, const World& world, const std::vector<AimedRay>& aimed, int threads,
                 const TellDefect& tell);

}  // namespace ctu::sim::metamorph
