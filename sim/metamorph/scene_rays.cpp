#include "sim/metamorph/scene_rays.h"

#include "model/reference/closest_hit.h"
#include "traces/ray_generator.h"

namespace ctu::sim::metamorph {

using intersect::Hit;
using intersect::Ray;

std::vector<Ray> scene_rays(const scene::Scene& scene, const accel::Bvh4& bvh,
                            const std::vector<traces::RayOptions>& kinds) {
  const reference::FastTracer tracer(bvh);
  const auto trace = [&](const Ray& ray, bool) { return tracer.closest(ray); };
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  for (const traces::RayOptions& options : kinds) {
    const traces::RayGenerator generator(scene, options);
    generator.generate(0, generator.paths(), trace, rays, hits);
  }
  return rays;
}

Ray reversed(const Ray& ray, float hit_t) {
  const double length = 2.0 * hit_t;
  Ray back{{}, 0, {}, static_cast<float>(length), intersect::RayKind::ClosestHit};
  for (int axis = 0; axis < 3; ++axis) {
    back.origin[axis] = static_cast<float>(ray.origin[axis] + length * ray.direction[axis]);
    back.direction[axis] = -ray.direction[axis];
  }
  return back;
}

}  // namespace ctu::sim::metamorph
