#include "model/scene/scene.h"

namespace ctu::scene {

// The counts come first, so that no vertex list can pass for a triangle list.
Hash128 content_hash(const Mesh& mesh) {
  static_assert(sizeof(Vec3) == 12 && sizeof(mesh.triangles[0]) == 12);
  Hasher hasher;
  const std::uint64_t counts[2] = {mesh.vertices.size(), mesh.triangles.size()};
  hasher.add(counts, sizeof(counts));
  hasher.add(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  hasher.add(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  return hasher.digest();
}

}  // namespace ctu::scene
