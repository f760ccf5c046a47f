#include "model/scene/scene.h"

#include <algorithm>
#include <limits>

namespace ctu::scene {

void measure_bounds(Scene& scene) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  scene.lower = {kInfinity, kInfinity, kInfinity};
  scene.upper = {-kInfinity, -kInfinity, -kInfinity};
  const auto grow = [&](const Vec3& lower, const Vec3& upper) {
    for (int axis = 0; axis < 3; ++axis) {
      scene.lower[axis] = std::min(scene.lower[axis], lower[axis]);
      scene.upper[axis] = std::max(scene.upper[axis], upper[axis]);
    }
  };
  for (const auto& triangle : scene.mesh.triangles)
    for (const std::uint32_t corner : triangle) grow(scene.mesh.vertices[corner], scene.mesh.vertices[corner]);
  for (const Sphere& sphere : scene.mesh.spheres) grow(lower_corner(sphere), upper_corner(sphere));
}

// The counts come first, so that no vertex list can pass for a triangle list.
Hash128 content_hash(const Mesh& mesh) {
  static_assert(sizeof(Vec3) == 12 && sizeof(mesh.triangles[0]) == 12 && sizeof(Sphere) == 16);
  Hasher hasher;
  const std::uint64_t counts[2] = {mesh.vertices.size(), mesh.triangles.size()};
  hasher.add(counts, sizeof(counts));
  hasher.add(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  hasher.add(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  if (!mesh.spheres.empty()) {
    const std::uint64_t spheres = mesh.spheres.size();
    hasher.add(&spheres, sizeof(spheres));
    hasher.add(mesh.spheres.data(), mesh.spheres.size() * sizeof(Sphere));
  }
  return hasher.digest();
}

}  // namespace ctu::scene
