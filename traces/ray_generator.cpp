#include "traces/ray_generator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/base/error.h"

namespace ctu::traces {
namespace {

using intersect::Hit;
using intersect::Ray;
using intersect::RayKind;
using Rays = RayOptions::Rays;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr std::uint32_t kTile = 8;  // pixels

struct Pixel {
  std::uint32_t x, y;
};

Pixel pixel_at(std::uint64_t index, const RayOptions& options) {
  if (!options.tiled)
    return {static_cast<std::uint32_t>(index % options.width), static_cast<std::uint32_t>(index / options.width)};
  // Rows of tiles; tiles at the right and lower edge are cut.
  const std::uint64_t band = static_cast<std::uint64_t>(options.width) * kTile;
  const std::uint32_t top = static_cast<std::uint32_t>(index / band) * kTile;
  const std::uint32_t rows = std::min(kTile, options.height - top);
  const std::uint64_t in_band = index % band;
  const std::uint32_t left = static_cast<std::uint32_t>(in_band / (rows * kTile)) * kTile;
  const std::uint32_t columns = std::min(kTile, options.width - left);
  const std::uint32_t in_tile = static_cast<std::uint32_t>(in_band - static_cast<std::uint64_t>(left) * rows);
  return {left + in_tile % columns, top + in_tile / columns};
}

double largest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The normal of the side that the ray came from.
Vec3d toward_arrival(const Vec3d& normal, const Vec3d& backwards) {
  return dot(normal, backwards) < 0 ? normal * -1 : normal;
}

Departure depart(const scene::Sphere& sphere, const Ray& arriving, const Hit& hit) {
  const Vec3d centre = widen(sphere.centre);
  const Vec3d at = widen(arriving.origin) + widen(arriving.direction) * static_cast<double>(hit.t);
  const Vec3d backwards = normalized(widen(arriving.direction) * -1, {0, 0, 1});
  const Vec3d outward = normalized(at - centre, backwards);
  const Vec3d normal = toward_arrival(outward, backwards);
  const double scale = largest(sphere.centre) + sphere.radius;
  return {centre + outward * static_cast<double>(sphere.radius) + normal * (scale * 0x1p-19), normal};
}

}  // namespace

Departure depart(const scene::Mesh& mesh, const Ray& arriving, const Hit& hit) {
  if (hit.primitive >= mesh.triangles.size())
    return depart(mesh.spheres[hit.primitive - mesh.triangles.size()], arriving, hit);
  const auto& corner = mesh.triangles[hit.primitive];
  const Vec3 corners[3] = {mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]};
  const Vec3d v0 = widen(corners[0]), v1 = widen(corners[1]), v2 = widen(corners[2]);
  const double u = hit.u, v = hit.v;
  const Vec3d point = v0 * (1 - u - v) + v1 * u + v2 * v;
  const Vec3d backwards = normalized(widen(arriving.direction) * -1, {0, 0, 1});
  const Vec3d normal = toward_arrival(normalized(cross(v1 - v0, v2 - v0), backwards), backwards);
  const double scale = std::max({largest(corners[0]), largest(corners[1]), largest(corners[2])});
  return {point + normal * (scale * 0x1p-19), normal};
}

RayGenerator::RayGenerator(const scene::Scene& scene, const RayOptions& options) : scene_(scene), options_(options) {
  check(options);
  const std::uint64_t samples = static_cast<std::uint64_t>(options.width) * options.height * options.samples_per_pixel;
  paths_ = options.kind == Rays::Random && options.count != 0 ? options.count : samples;
  diagonal_ = length(widen(scene.upper) - widen(scene.lower));
  light_ = options.light ? *options.light : default_light(scene);

  const scene::Camera& camera = scene.camera;
  if (!(camera.vertical_fov_degrees > 0 && camera.vertical_fov_degrees < 180))
    throw Error(scene.name, "the camera's field of view is not between 0 and 180 degrees", "correct the camera");
  const Vec3d forward = normalized(widen(camera.target) - widen(camera.eye), {0, 0, -1});
  // An up vector along the view has no say; any other axis will do.
  const Vec3d other = std::abs(forward.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  const Vec3d right = normalized(cross(forward, widen(camera.up)), normalized(cross(forward, other), {1, 0, 0}));
  const SinCos half = sin_cos(camera.vertical_fov_degrees * kDegree / 2);
  const double tall = half.sin / half.cos, wide = tall * options.width / options.height;
  basis_ = {forward, right * wide, cross(right, forward) * tall};
}

std::uint32_t RayGenerator::max_rays_per_path() const {
  return options_.kind == Rays::Diffuse ? options_.bounces + 1 - (options_.skip_primary ? 1 : 0) : 1;
}

Ray RayGenerator::primary_ray(std::uint32_t x, std::uint32_t y, std::uint32_t sample) const {
  const std::uint64_t pixel = static_cast<std::uint64_t>(y) * options_.width + x;
  double in_x = 0.5, in_y = 0.5;
  if (options_.jitter) {
    const auto random = random_numbers(options_.seed, pixel, sample, 0);
    in_x = random[0], in_y = random[1];
  }
  const double across = 2 * (x + in_x) / options_.width - 1, down = 2 * (y + in_y) / options_.height - 1;
  const Vec3d direction = normalized(basis_.forward + basis_.right * across - basis_.up * down, basis_.forward);
  return {scene_.camera.eye, 0, round_to_nearest(direction), kInfinity, RayKind::ClosestHit};
}

Ray RayGenerator::random_line(std::uint64_t index) const {
  const auto random = random_numbers(options_.seed, index, 0, 0);
  const Vec3d centre = (widen(scene_.lower) + widen(scene_.upper)) * 0.5;
  const double radius = diagonal_ > 0 ? 0.505 * diagonal_ : 1;
  const Vec3 from = round_to_nearest(centre + sphere_point(random[0], random[1]) * radius);
  const Vec3d to = centre + sphere_point(random[2], random[3]) * radius;
  const Vec3d direction = normalized(to - widen(from), {0, 0, 1});
  return {from, 0, round_to_nearest(direction), kInfinity, RayKind::ClosestHit};
}

Ray RayGenerator::secondary(const Ray& arriving, const Hit& hit, std::uint64_t pixel, std::uint32_t sample,
                            std::uint32_t bounce) const {
  const Departure from = depart(scene_.mesh, arriving, hit);
  const Vec3 origin = round_to_nearest(from.point);
  if (options_.kind == Rays::Shadow) {
    const Vec3d to_light = widen(light_) - widen(origin);
    // The light itself is no occluder: the ray ends 2^-20 of its length before it.
    const float distance = static_cast<float>(length(to_light) * (1 - 0x1p-20));
    return {origin, 0, round_to_nearest(normalized(to_light, from.normal)), distance, RayKind::AnyHit};
  }
  const auto random = random_numbers(options_.seed, pixel, sample, bounce);
  const Vec3d direction = normalized(cosine_direction(from.normal, random[0], random[1]), from.normal);
  if (options_.kind == Rays::Ao)
    return {origin, 0, round_to_nearest(direction), static_cast<float>(options_.ao_radius * diagonal_),
            RayKind::AnyHit};
  return {origin, 0, round_to_nearest(direction), kInfinity, RayKind::ClosestHit};
}

void RayGenerator::walk_path(std::uint64_t path, const TraceRay& trace, std::vector<Ray>& rays,
                             std::vector<Hit>& hits) const {
  const auto emit = [&](const Ray& ray) {
    rays.push_back(ray);
    hits.push_back(trace(ray, true));
    return hits.back();
  };
  if (options_.kind == Rays::Random) {
    emit(random_line(path));
    return;
  }
  const auto [x, y] = pixel_at(path / options_.samples_per_pixel, options_);
  const auto sample = static_cast<std::uint32_t>(path % options_.samples_per_pixel);
  const std::uint64_t pixel = static_cast<std::uint64_t>(y) * options_.width + x;
  Ray ray = primary_ray(x, y, sample);
  const bool keep_primary =
      options_.kind == Rays::Primary || (options_.kind == Rays::Diffuse && !options_.skip_primary);
  Hit hit = keep_primary ? emit(ray) : trace(ray, false);
  const std::uint32_t bounces = options_.kind == Rays::Primary   ? 0
                                : options_.kind == Rays::Diffuse ? options_.bounces
                                                                 : 1;
  for (std::uint32_t bounce = 1; bounce <= bounces && hit.primitive != intersect::kNoPrimitive; ++bounce) {
    ray = secondary(ray, hit, pixel, sample, bounce);
    hit = emit(ray);
  }
}

void RayGenerator::generate(std::uint64_t first, std::uint64_t last, const TraceRay& trace, std::vector<Ray>& rays,
                            std::vector<Hit>& hits) const {
  for (std::uint64_t path = first; path < last && path < paths_; ++path) walk_path(path, trace, rays, hits);
}

Vec3 default_light(const scene::Scene& scene) {
  const Vec3& eye = scene.camera.eye;
  const Vec3& up = scene.camera.up;
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(up[a]) > std::abs(up[axis])) axis = a;
  bool inside = true;
  for (int a = 0; a < 3; ++a) inside = inside && eye[a] >= scene.lower[a] && eye[a] <= scene.upper[a];

  const Vec3d low = widen(scene.lower), high = widen(scene.upper);
  Vec3 light = round_to_nearest((low + high) * 0.5);
  const double half_height = (static_cast<double>(scene.upper[axis]) - scene.lower[axis]) * 0.5;
  const double lift = inside ? 0.9 * half_height : half_height + 0.75 * length(high - low);
  const double towards = up[axis] < 0 ? -1 : 1;
  light[axis] = static_cast<float>(light[axis] + towards * lift);
  return light;
}

}  // namespace ctu::traces
