#include "tests/check/hard_case_facts.h"

#include <algorithm>
#include <cmath>

#include "model/accel/build.h"
#include "model/scene/vector64.h"
#include "tests/oracle/exact_triangle.h"

namespace ctu::test {

using scene::Vector64;

std::vector<Box> boxes_of_tree(const scene::Mesh& mesh) {
  std::vector<Box> boxes;
  for (const accel::Node4& node : accel::build(mesh, {}).nodes)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      Box box;
      for (int a = 0; a < 3; ++a) box.lower[a] = node.boxes.lo[a][lane], box.upper[a] = node.boxes.hi[a][lane];
      if (box.lower.x <= box.upper.x) boxes.push_back(box);
    }
  return boxes;
}

namespace {
double side(const Box& box, int axis) { return static_cast<double>(box.upper[axis]) - box.lower[axis]; }
}  // namespace

int flat_axes(const Box& box) {
  int flat = 0;
  for (int a = 0; a < 3; ++a) flat += side(box, a) == 0;
  return flat;
}

double longest_side(const Box& box) { return std::max({side(box, 0), side(box, 1), side(box, 2)}); }

double aspect(const Box& box) {
  double shortest = longest_side(box);
  for (int a = 0; a < 3; ++a)
    if (side(box, a) > 0) shortest = std::min(shortest, side(box, a));
  return shortest == 0 ? 1 : longest_side(box) / shortest;
}

int faces_met(const Box& box, const Vec3& point) {
  int met = 0;
  for (int a = 0; a < 3; ++a) {
    if (point[a] < box.lower[a] || point[a] > box.upper[a]) return -1;
    met += point[a] == box.lower[a] || point[a] == box.upper[a];
  }
  return met;
}

bool strictly_inside(const Box& box, const Vec3& point) { return faces_met(box, point) == 0; }

bool on_cell_border(const Box& box, const Vec3& point, int resolution) {
  if (faces_met(box, point) < 0) return false;
  for (int a = 0; a < 3; ++a) {
    if (side(box, a) == 0) continue;
    // Small integers times one power of two in the cases that this is asked of: exact.
    const double place = (static_cast<double>(point[a]) - box.lower[a]) * resolution;
    for (int k = 1; k < resolution; ++k)
      if (place == k * side(box, a)) return true;
  }
  return false;
}

double longest_edge(const scene::Mesh& mesh, std::size_t triangle) {
  double longest = 0;
  const auto& corners = mesh.triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i)
    longest =
        std::max(longest, length(Vector64(mesh.vertices[corners[(i + 1) % 3]]) - Vector64(mesh.vertices[corners[i]])));
  return longest;
}

double thinness(const scene::Mesh& mesh, std::size_t triangle) {
  const auto& corners = mesh.triangles[triangle];
  const Vector64 a(mesh.vertices[corners[0]]), b(mesh.vertices[corners[1]]), c(mesh.vertices[corners[2]]);
  const double twice_area = length(cross(b - a, c - a)), longest = longest_edge(mesh, triangle);
  return twice_area == 0 ? 0 : twice_area / (longest * longest);
}

Box bounds(const scene::Mesh& mesh) {
  Box box{mesh.vertices[0], mesh.vertices[0]};
  for (const Vec3& v : mesh.vertices)
    for (int a = 0; a < 3; ++a) {
      box.lower[a] = std::min(box.lower[a], v[a]);
      box.upper[a] = std::max(box.upper[a], v[a]);
    }
  return box;
}

ExactMeeting exact_meeting(const scene::Mesh& mesh, const intersect::Ray& ray, float tmin, float tmax) {
  ExactMeeting meeting;
  const std::array<std::uint32_t, 3>* before = nullptr;
  for (const auto& corners : mesh.triangles) {
    const Vec3 &v0 = mesh.vertices[corners[0]], &v1 = mesh.vertices[corners[1]], &v2 = mesh.vertices[corners[2]];
    // Copies of one triangle follow each other.
    if (before != nullptr && v0 == mesh.vertices[(*before)[0]] && v1 == mesh.vertices[(*before)[1]] &&
        v2 == mesh.vertices[(*before)[2]])
      continue;
    before = &corners;
    const oracle::ExactTriangleHit hit = oracle::exact_ray_triangle(ray, v0, v1, v2, tmin, tmax);
    if (!hit.hit) continue;
    if (!meeting.hit || hit.nearest_t < meeting.t) meeting.t = hit.nearest_t;
    meeting.hit = true;
    meeting.on_edge |= hit.on_edge;
    meeting.edge_on |= hit.edge_on;
  }
  return meeting;
}

}  // namespace ctu::test
