#include "tests/accel/meshes.h"

#include <cmath>
#include <functional>
#include <random>

#include "model/scene/load.h"

namespace ctu::test {
namespace {

void add(scene::Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// A triangle of about `size` at `at`.
void add_at(scene::Mesh& mesh, const Vec3& at, float size) {
  add(mesh, at, {at.x + size, at.y, at.z}, {at.x, at.y + size, at.z + size});
}

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  float operator()(float a, float b) { return a + (b - a) * (static_cast<float>(engine_() >> 40) * 0x1p-24f); }
  Vec3 point() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }

 private:
  std::mt19937_64 engine_;
};

scene::Mesh soup(int count, float size, Dice& dice) {
  scene::Mesh mesh;
  for (int i = 0; i < count; ++i) add_at(mesh, dice.point(), size * dice(0.1f, 1));
  return mesh;
}

scene::Mesh mapped(scene::Mesh mesh, const std::function<Vec3(Vec3)>& map) {
  for (Vec3& v : mesh.vertices) v = map(v);
  return mesh;
}

scene::Mesh giant_among_tiny(Dice& dice) {
  scene::Mesh mesh = soup(3000, 1e-4f, dice);
  add(mesh, {-1e4f, -1e4f, 0}, {1e4f, -1e4f, 1}, {0, 1e4f, -1});
  return mesh;
}

/// Binning puts all but the last few in one bin, again and again.
scene::Mesh doubling_chain(int count) {
  scene::Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float at = std::ldexp(1.0f, i % 240 - 120);
    add_at(mesh, {at, at, at}, at / 4);
  }
  return mesh;
}

/// Boxes inside boxes, all around the same centre.
scene::Mesh onion(int count) {
  scene::Mesh mesh;
  for (int i = 1; i <= count; ++i) {
    const auto r = static_cast<float>(i);
    add(mesh, {-r, -r, -r}, {r, r, r}, {r, -r, r});
  }
  return mesh;
}

}  // namespace

scene::Mesh equal_triangles(int count) {
  scene::Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0.5f}, {0, 1, 0.25f}};
  mesh.triangles.assign(static_cast<std::size_t>(count), {0, 1, 2});
  return mesh;
}

std::vector<NamedMesh> adversarial_meshes(std::uint64_t seed) {
  Dice dice(seed);
  std::vector<NamedMesh> meshes;
  for (const int count : {1, 2, 3, 4, 5, 8, 9, 16, 17})
    meshes.push_back({"soup of " + std::to_string(count), soup(count, 0.3f, dice)});
  const scene::Mesh base = soup(2000, 0.05f, dice);
  meshes.push_back({"soup", base});
  meshes.push_back({"large soup", soup(30000, 0.02f, dice)});  // enough for threads to share
  meshes.push_back({"1000 equal", equal_triangles(1000)});
  meshes.push_back({"20000 equal", equal_triangles(20000)});
  meshes.push_back({"giant among tiny", giant_among_tiny(dice)});
  meshes.push_back({"doubling chain", doubling_chain(2000)});
  meshes.push_back({"onion", onion(2000)});
  meshes.push_back({"in a plane", mapped(base, [](Vec3 v) { return Vec3{v.x, 2.5f, v.z}; })});
  meshes.push_back({"on a line", mapped(base, [](Vec3 v) { return Vec3{v.x, 0, -1}; })});
  meshes.push_back({"in a point", mapped(base, [](Vec3) { return Vec3{3, -4, 5}; })});
  meshes.push_back({"at the origin", mapped(base, [](Vec3) { return Vec3{0, -0.0f, 0}; })});
  meshes.push_back({"huge", mapped(base, [](Vec3 v) { return Vec3{v.x * 3e38f, v.y * 3e38f, v.z * 3e38f}; })});
  meshes.push_back({"tiny", mapped(base, [](Vec3 v) { return Vec3{v.x * 1e-38f, v.y * 1e-41f, v.z * 1e-44f}; })});
  meshes.push_back({"far away", mapped(base, [](Vec3 v) { return Vec3{v.x + 1e6f, v.y - 1e7f, v.z}; })});
  meshes.push_back({"hair", scene::load("gen:curly-hair?strands=60").mesh});
  meshes.push_back({"quads", scene::load("gen:tilted-quads?quads=2000").mesh});
  meshes.push_back({"tetra", scene::load("gen:tetra?depth=6").mesh});
  return meshes;
}

}  // namespace ctu::test
