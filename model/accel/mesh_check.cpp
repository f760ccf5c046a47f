#include "model/accel/mesh_check.h"

#include <fmt/format.h>

#include "model/accel/node_box.h"
#include "model/base/error.h"
#include "model/base/parallel.h"

namespace ctu::accel {
namespace {

constexpr std::size_t kChunkTriangles = 16384;

/// Whether the three corners exist and are finite: x - x is 0 for those, NaN for the others.
bool is_usable(const scene::Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  for (const std::uint32_t corner : corners) {
    if (corner >= mesh.vertices.size()) return false;
    const Vec3& v = mesh.vertices[corner];
    if (!((v.x - v.x) + (v.y - v.y) + (v.z - v.z) == 0)) return false;
  }
  return true;
}

bool is_usable(const scene::Sphere& sphere) {
  const Vec3 lower = lower_corner(sphere), upper = upper_corner(sphere);
  float sum = sphere.radius >= 0 ? 0.0f : 1.0f;
  for (int axis = 0; axis < 3; ++axis) sum += (lower[axis] - lower[axis]) + (upper[axis] - upper[axis]);
  return sum == 0;
}

}  // namespace

Box3 checked_bounds(const scene::Mesh& mesh, int threads) {
  const std::size_t count = mesh.triangles.size();
  std::vector<Box3> partial((count + kChunkTriangles - 1) / kChunkTriangles, Box3::empty());
  parallel_chunks(count, kChunkTriangles, threads, [&](std::size_t first, std::size_t last) {
    Box3 box = Box3::empty();
    for (std::size_t i = first; i < last; ++i) {
      if (!is_usable(mesh, mesh.triangles[i]))
        throw Error(fmt::format("mesh, triangle {}", i), "a vertex is missing or not finite",
                    "remove the triangle or repair the vertex");
      for (const std::uint32_t corner : mesh.triangles[i]) box.grow(to_vector(mesh.vertices[corner]));
    }
    partial[first / kChunkTriangles] = box;
  });
  Box3 bounds = Box3::empty();
  for (const Box3& box : partial) bounds.grow(box);
  for (std::size_t s = 0; s < mesh.spheres.size(); ++s) {
    if (!is_usable(mesh.spheres[s]))
      throw Error(fmt::format("mesh, sphere {}", s), "not finite, or of a radius that is no size",
                  "remove the sphere or repair it");
    bounds.grow(box_of(mesh.spheres[s]));
  }
  return bounds;
}

}  // namespace ctu::accel
