#include "tests/reference/rays.h"

#include <cmath>
#include <limits>
#include <random>

namespace ctu::test {
namespace {

constexpr float kForever = std::numeric_limits<float>::infinity();

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 operator*(float s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec3 normalized(const Vec3& a) { return (1.0f / std::sqrt(dot(a, a))) * a; }

float uniform(std::mt19937_64& random) { return static_cast<float>(random() >> 40) * 0x1p-24f; }

Vec3 cosine_direction(const Vec3& normal, std::mt19937_64& random) {
  const float height = 2 * uniform(random) - 1, angle = 6.2831853f * uniform(random);
  const float radius = std::sqrt(std::max(0.0f, 1 - height * height));
  return normal + Vec3{radius * std::cos(angle), radius * std::sin(angle), height};
}

}  // namespace

std::vector<intersect::Ray> primary_rays(const scene::Scene& scene, int width, int height) {
  const scene::Camera& camera = scene.camera;
  const Vec3 forward = normalized(camera.target - camera.eye);
  const Vec3 right = normalized(cross(forward, camera.up));
  const Vec3 up = cross(right, forward);
  const float half = std::tan(camera.vertical_fov_degrees * 0.00872664626f);
  std::vector<intersect::Ray> rays;
  rays.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int ty = 0; ty < height; ty += 4) {
    for (int tx = 0; tx < width; tx += 4) {
      for (int i = 0; i < 16; ++i) {
        const int x = tx + i % 4, y = ty + i / 4;
        if (x >= width || y >= height) continue;
        const float sx =
            half * (2 * (static_cast<float>(x) + 0.5f) - static_cast<float>(width)) / static_cast<float>(height);
        const float sy = half * (1 - 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
        rays.push_back({camera.eye, 0, normalized(forward + sx * right + sy * up), kForever});
      }
    }
  }
  return rays;
}

std::vector<intersect::Ray> diffuse_rays(const scene::Scene& scene, const reference::FastTracer& tracer,
                                         const std::vector<intersect::Ray>& from, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Vec3 extent = scene.upper - scene.lower;
  const float offset = 1e-4f * std::sqrt(dot(extent, extent));
  std::vector<intersect::Ray> rays;
  for (const intersect::Ray& ray : from) {
    const intersect::Hit hit = tracer.closest(ray);
    if (hit.primitive == intersect::kNoPrimitive) continue;
    const auto& corners = scene.mesh.triangles[hit.primitive];
    const Vec3 v0 = scene.mesh.vertices[corners[0]];
    Vec3 normal = cross(scene.mesh.vertices[corners[1]] - v0, scene.mesh.vertices[corners[2]] - v0);
    if (dot(normal, normal) == 0) continue;
    normal = normalized(normal);
    if (dot(normal, ray.direction) > 0) normal = -1.0f * normal;
    const Vec3 direction = cosine_direction(normal, random);
    if (dot(direction, direction) < 1e-6f) continue;
    rays.push_back({ray.origin + hit.t * ray.direction + offset * normal, 0, normalized(direction), kForever});
  }
  return rays;
}

std::vector<intersect::Ray> random_rays(const scene::Scene& scene, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto point = [&] {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = scene.upper[axis] - scene.lower[axis];
      p[axis] = scene.lower[axis] + extent * (1.5f * uniform(random) - 0.25f);
    }
    return p;
  };
  std::vector<intersect::Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 from = point(), to = point();
    if (from == to) continue;
    rays.push_back({from, 0, to - from, kForever});
  }
  return rays;
}

std::vector<intersect::Ray> aimed_rays(const scene::Scene& scene, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Vec3 middle = 0.5f * (scene.lower + scene.upper), extent = scene.upper - scene.lower;
  std::vector<intersect::Ray> rays;
  for (int i = 0; i < count; ++i) {
    const auto& corners = scene.mesh.triangles[random() % scene.mesh.triangles.size()];
    const Vec3 a = scene.mesh.vertices[corners[0]], b = scene.mesh.vertices[corners[1]];
    const Vec3 at = random() % 2 == 0 ? a : 0.5f * (a + b);
    const Vec3 out = cosine_direction({0, 0, 0}, random);
    const Vec3 from = middle + 1.5f * std::sqrt(dot(extent, extent)) * out;
    rays.push_back({from, 0, at - from, kForever});
  }
  return rays;
}

}  // namespace ctu::test
