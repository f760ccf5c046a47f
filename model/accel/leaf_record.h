// A primitive of a scene as leaves keep it.
#pragma once

#include <cassert>
#include <cstdint>

#include "model/accel/bvh4.h"
#include "model/scene/scene.h"

namespace ctu::accel {

/// Of the primitive `id`, which is below mesh.primitives().
inline LeafTriangle leaf_record(const scene::Mesh& mesh, std::uint32_t id) {
  assert(id < mesh.primitives());
  if (id >= mesh.triangles.size()) return LeafTriangle::of(mesh.spheres[id - mesh.triangles.size()], id);
  const auto& [a, b, c] = mesh.triangles[id];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], id};
}

}  // namespace ctu::accel
