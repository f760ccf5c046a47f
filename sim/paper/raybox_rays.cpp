#include "sim/paper/raybox_rays.h"

#include <limits>

#include "traces/sampling.h"

namespace ctu::sim::paper {
namespace {

using intersect::Hit;
using intersect::Ray;
using intersect::RayKind;

traces::RayOptions picture(const RayboxSetting& setting) {
  traces::RayOptions options;
  options.kind = traces::RayOptions::Rays::Primary;
  options.width = setting.width;
  options.height = setting.height;
  options.samples_per_pixel = setting.samples;
  options.seed = setting.seed;
  return options;
}

/// Nothing where the surface is turned away: pbrt asks no ray then.
void add_shadow_ray(const traces::Departure& from, const RayboxLight& light, std::vector<Ray>& rays) {
  const Vec3 origin = traces::round_to_nearest(from.point);
  const traces::Vec3d to_light = traces::widen(light.position) - traces::widen(origin);
  const double distance = traces::length(to_light) * (1 - 0x1p-20) - 1.001 * static_cast<double>(light.radius);
  if (!(traces::dot(from.normal, to_light) > 0) || !(distance > 0)) return;
  const Vec3 direction = traces::round_to_nearest(traces::normalized(to_light, from.normal));
  rays.push_back({origin, 0, direction, static_cast<float>(distance), RayKind::AnyHit});
}

}  // namespace

RayboxRays::RayboxRays(const scene::Scene& scene, const RayboxSetting& setting, const reference::Traversal& traversal)
    : scene_(scene), setting_(setting), traversal_(traversal), generator_(scene, picture(setting)) {
  if (setting_.lights.empty()) setting_.lights.push_back({traces::default_light(scene), 0});
}

void RayboxRays::walk_path(std::uint64_t path, std::vector<Ray>& rays) const {
  const std::uint64_t pixel = path / setting_.samples;
  const auto sample = static_cast<std::uint32_t>(path % setting_.samples);
  Ray ray = generator_.primary_ray(static_cast<std::uint32_t>(pixel % setting_.width),
                                   static_cast<std::uint32_t>(pixel / setting_.width), sample);
  for (int bounce = 0;; ++bounce) {
    rays.push_back(ray);
    const Hit hit = traversal_.trace(ray);
    if (hit.primitive == intersect::kNoPrimitive) return;
    const traces::Departure from = traces::depart(scene_.mesh, ray, hit);
    for (const RayboxLight& light : setting_.lights) add_shadow_ray(from, light, rays);
    if (bounce == setting_.bounces) return;
    const auto random = traces::random_numbers(setting_.seed, pixel, sample, static_cast<std::uint32_t>(bounce) + 1);
    const traces::Vec3d direction =
        traces::normalized(traces::cosine_direction(from.normal, random[0], random[1]), from.normal);
    ray = {traces::round_to_nearest(from.point), 0, traces::round_to_nearest(direction),
           std::numeric_limits<float>::infinity(), RayKind::ClosestHit};
  }
}

void RayboxRays::generate(std::uint64_t first, std::uint64_t last, std::vector<Ray>& rays) const {
  for (std::uint64_t path = first; path < last && path < paths(); ++path) walk_path(path, rays);
}

}  // namespace ctu::sim::paper
