// What is true of a hard case, measured apart from how it was made: for tests that a generator keeps its name's
// promise.
#pragma once

#include <vector>

#include "model/intersect/slab_test.h"
#include "sim/check/hard_case.h"

namespace ctu::test {

struct Box {
  Vec3 lower, upper;
};

/// The boxes of all lanes of the tree that the builder makes of the mesh.
std::vector<Box> boxes_of_tree(const scene::Mesh& mesh);

/// Axes on which the box is flat.
int flat_axes(const Box& box);
/// Longest side over the shortest one that is not zero.
double aspect(const Box& box);
double longest_side(const Box& box);

/// Coordinates of a point in the closed box that lie on faces; -1 for a point outside.
int faces_met(const Box& box, const Vec3& point);
bool strictly_inside(const Box& box, const Vec3& point);
/// Whether a point in the closed box lies on an inner border of its R^3 cells, in exact arithmetic.
bool on_cell_border(const Box& box, const Vec3& point, int resolution);

/// Of a triangle: smallest height over longest edge; 0 without area. To binary64's accuracy.
double thinness(const scene::Mesh& mesh, std::size_t triangle);
double longest_edge(const scene::Mesh& mesh, std::size_t triangle);
Box bounds(const scene::Mesh& mesh);

/// What a ray meets in exact arithmetic, of all triangles.
struct ExactMeeting {
  bool hit = false, on_edge = false, edge_on = false;
  double t = 0;  ///< the first
};
ExactMeeting exact_meeting(const scene::Mesh& mesh, const intersect::Ray& ray, float tmin, float tmax);
inline ExactMeeting exact_meeting(const scene::Mesh& mesh, const intersect::Ray& ray) {
  return exact_meeting(mesh, ray, ray.tmin, ray.tmax);
}

}  // namespace ctu::test
