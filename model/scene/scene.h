// A scene as everything after it sees it: triangles in world space, a camera, and how it was read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/base/hash.h"
#include "model/numeric/vec3.h"

namespace ctu::scene {

/// Indexed triangles; a triangle's position in the list is its primitive id.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct Camera {
  Vec3 eye, target, up{0, 1, 0};
  float vertical_fov_degrees = 45;
  bool from_file = false;  ///< false: placed by default_camera() to see the whole scene
};

/// What a reader met, for the user and for the counts of the scene's documentation.
struct LoadReport {
  std::string format;  ///< "obj", "ply", "gltf", "pbrt", "hair", "tfx", "nff", "luxcore", "generated"
  std::uint64_t strands = 0, segments = 0;
  std::uint64_t instances = 0;
  std::uint64_t zero_area_triangles = 0;
  std::vector<std::string> warnings;  ///< one line each: element, what was done
};

struct Scene {
  std::string name;
  Mesh mesh;
  Camera camera;
  LoadReport report;
  Vec3 lower, upper;  ///< bounds of all vertices that triangles use
};

/// Identity of the geometry: the hash of vertices and triangles.
Hash128 content_hash(const Mesh& mesh);

}  // namespace ctu::scene
