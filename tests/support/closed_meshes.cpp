#include "tests/support/closed_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace ctu::test {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

Vec3 on_sphere(double x, double y, double z) {
  const double scale = 1 / std::sqrt(x * x + y * y + z * z);
  return {static_cast<float>(x * scale), static_cast<float>(y * scale), static_cast<float>(z * scale)};
}

/// Vertices shared by position on an edge or lattice, so that neighbours have the same bits.
class MidpointCutter {
 public:
  explicit MidpointCutter(scene::Mesh& mesh) : mesh_(mesh) {}
  std::uint32_t midpoint(std::uint32_t a, std::uint32_t b) {
    const std::pair<std::uint32_t, std::uint32_t> key = std::minmax(a, b);
    const auto found = made_.find(key);
    if (found != made_.end()) return found->second;
    const Vec3 p = mesh_.vertices[a], q = mesh_.vertices[b];
    mesh_.vertices.push_back(on_sphere(double(p.x) + q.x, double(p.y) + q.y, double(p.z) + q.z));
    return made_[key] = static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

 private:
  scene::Mesh& mesh_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made_;
};

scene::Mesh icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const double corners[12][3] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  scene::Mesh mesh;
  for (const auto& c : corners) mesh.vertices.push_back(on_sphere(c[0], c[1], c[2]));
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

}  // namespace

scene::Mesh icosphere(int levels) {
  scene::Mesh mesh = icosahedron();
  for (int level = 0; level < levels; ++level) {
    MidpointCutter cutter(mesh);
    std::vector<Triangle> finer;
    finer.reserve(mesh.triangles.size() * 4);
    for (const Triangle& t : mesh.triangles) {
      const std::uint32_t ab = cutter.midpoint(t[0], t[1]), bc = cutter.midpoint(t[1], t[2]),
                          ca = cutter.midpoint(t[2], t[0]);
      finer.insert(finer.end(), {Triangle{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

scene::Mesh lattice_cube(int n) {
  scene::Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> made;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [place, is_new] = made.try_emplace(at, static_cast<std::uint32_t>(mesh.vertices.size()));
    const auto coordinate = [n](int i) { return static_cast<float>(2.0 * i / n - 1.0); };
    if (is_new) mesh.vertices.push_back({coordinate(at[0]), coordinate(at[1]), coordinate(at[2])});
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            return vertex(at);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          mesh.triangles.push_back({a, b, c});
          mesh.triangles.push_back({a, c, d});
        }
  return mesh;
}

scene::Mesh moved(scene::Mesh mesh, const Vec3& offset) {
  for (Vec3& v : mesh.vertices) v = {v.x + offset.x, v.y + offset.y, v.z + offset.z};
  return mesh;
}

ClosedMesh closed_sphere(int levels) { return {icosphere(levels), {0, 0, 0}, 0.98}; }
ClosedMesh closed_cube(int n) { return {lattice_cube(n), {0, 0, 0}, 1}; }

ClosedMesh moved(const ClosedMesh& closed) {
  const Vec3 far_away{1000, 2000, -3000};
  return {moved(closed.mesh, far_away), far_away, closed.size};
}

ClosedMesh scaled(ClosedMesh closed, float factor) {
  for (Vec3& v : closed.mesh.vertices) v = {v.x * factor, v.y * factor, v.z * factor};
  closed.size *= factor;
  return closed;
}

}  // namespace ctu::test
