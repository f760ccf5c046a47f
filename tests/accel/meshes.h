// Meshes that are hard on a builder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace ctu::test {

struct NamedMesh {
  std::string name;
  scene::Mesh mesh;
};

/// `count` times the same triangle.
scene::Mesh equal_triangles(int count);

/// One to `largest` triangles, equal centres, one giant among tiny ones, a chain in which every triangle is twice as
/// far out as the one before, all on a line, all in a plane, no area at all, extreme coordinates, and ordinary scenes.
std::vector<NamedMesh> adversarial_meshes(std::uint64_t seed);

}  // namespace ctu::test
