// A scene as everything after it sees it: triangles and spheres in world space, a camera, and how it was read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/base/hash.h"
#include "model/numeric/vec3.h"
#include "model/scene/sphere.h"

namespace ctu::scene {

/// Indexed triangles, and spheres. A triangle's position in its list is its primitive id; the ids of spheres follow.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Sphere> spheres = {};

  std::size_t primitives() const { return triangles.size() + spheres.size(); }
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
  Vec3 lower, upper;  ///< bounds of all spheres and of the vertices that triangles use
};

/// Sets the scene's bounds from its mesh, which must have a primitive.
void measure_bounds(Scene& scene);

/// Identity of the geometry: the hash of vertices and triangles, and of spheres where there are any.
Hash128 content_hash(const Mesh& mesh);

}  // namespace ctu::scene
