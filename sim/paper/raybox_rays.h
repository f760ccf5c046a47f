// The rays of "Ray-Box Culling for Tree Structures": what pbrt's direct-lighting and path integrators send into its
// scenes, as far as the paper says and without materials. A camera ray; from what it hits a shadow ray to each light
// that the surface faces; in path tracing the same again from where a cosine-weighted ray hits.
#pragma once

#include <cstdint>
#include <vector>

#include "model/intersect/ray.h"
#include "model/reference/traversal.h"
#include "model/scene/scene.h"
#include "traces/ray_generator.h"

namespace ctu::sim::paper {

struct RayboxLight {
  Vec3 position;
  float radius = 0;  ///< shadow rays end so far before it, where its own surface is
};

struct RayboxSetting {
  std::uint32_t width = 256, height = 256, samples = 1;
  std::vector<RayboxLight> lights;  ///< none: traces::default_light()
  int bounces = 0;                  ///< of a path; 0: direct lighting
  std::uint64_t seed = 1;
};

class RayboxRays {
 public:
  /// The scene and the traversal, which must not cull, must outlive this.
  RayboxRays(const scene::Scene& scene, const RayboxSetting& setting, const reference::Traversal& traversal);

  std::uint64_t paths() const { return generator_.paths(); }
  /// Appends the rays of paths [first, last).
  void generate(std::uint64_t first, std::uint64_t last, std::vector<intersect::Ray>& rays) const;

 private:
  void walk_path(std::uint64_t path, std::vector<intersect::Ray>& rays) const;

  const scene::Scene& scene_;
  RayboxSetting setting_;
  const reference::Traversal& traversal_;
  traces::RayGenerator generator_;
};

}  // namespace ctu::sim::paper
