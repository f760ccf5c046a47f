// The rays that every form of a scene is asked: made once, on the scene as it is, and transformed with it.
#pragma once

#include <vector>

#include "model/accel/bvh4.h"
#include "model/intersect/ray.h"
#include "model/scene/scene.h"
#include "traces/ray_options.h"

namespace ctu::sim::metamorph {

/// All rays that `kinds` describe, one kind after the other.
std::vector<intersect::Ray> scene_rays(const scene::Scene& scene, const accel::Bvh4& bvh,
                                       const std::vector<traces::RayOptions>& kinds);

/// The ray back over the same line, from as far behind the hit as the hit is from the origin, back to the origin.
/// Its origin is rounded: a ray of its own. Not valid (is_valid) where that is not finite.
intersect::Ray reversed(const intersect::Ray& ray, float hit_t);

}  // namespace ctu::sim::metamorph
