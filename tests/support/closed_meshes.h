// Closed meshes whose every outside-to-inside ray must hit: nothing may leak through an edge or a vertex.
#pragma once

#include "model/scene/scene.h"

namespace ctu::test {

/// A sphere of radius 1 about the origin: an icosahedron, each triangle cut into four `levels` times (20 * 4^levels).
scene::Mesh icosphere(int levels);

/// The cube [-1, 1]^3, each face a lattice of n x n cells of two triangles: flat boxes, coordinates on a lattice.
scene::Mesh lattice_cube(int n);

struct ClosedMesh {
  scene::Mesh mesh;
  Vec3 middle;  ///< well inside
  double size;  ///< about the distance from there to the surface
};
ClosedMesh closed_sphere(int levels);
ClosedMesh closed_cube(int n);

/// Moved by (1000, 2000, -3000); scaled by a factor.
ClosedMesh moved(const ClosedMesh& closed);
ClosedMesh scaled(ClosedMesh closed, float factor);

/// Every vertex moved by `offset`, rounded once.
scene::Mesh moved(scene::Mesh mesh, const Vec3& offset);

}  // namespace ctu::test
