// Rays for tests and benchmarks of the closest hit.
#pragma once

#include <cstdint>
#include <vector>

#include "model/intersect/ray.h"
#include "model/reference/closest_hit.h"
#include "model/scene/scene.h"

namespace ctu::test {

/// One ray through the middle of every pixel of the scene's camera, in tiles of 4x4 pixels.
std::vector<intersect::Ray> primary_rays(const scene::Scene& scene, int width, int height);

/// One cosine-distributed bounce from every hit of `from`, off the side that the ray came from.
std::vector<intersect::Ray> diffuse_rays(const scene::Scene& scene, const reference::FastTracer& tracer,
                                         const std::vector<intersect::Ray>& from, std::uint64_t seed);

/// Lines between two random points of the scene's bounds, grown by half; whole lines, not segments.
std::vector<intersect::Ray> random_rays(const scene::Scene& scene, int count, std::uint64_t seed);

/// From outside the scene's bounds at vertices and at the middles of edges, where tests by rounding differ most.
std::vector<intersect::Ray> aimed_rays(const scene::Scene& scene, int count, std::uint64_t seed);

}  // namespace ctu::test
