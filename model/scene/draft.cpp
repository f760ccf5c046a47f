#include "model/scene/draft.h"

#include <fmt/core.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "model/base/error.h"
#include "model/scene/camera.h"

namespace ctu::scene {
namespace {

constexpr std::size_t kMostWarnings = 50;

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_mesh(const Mesh& mesh, const std::string& where) {
  if (mesh.primitives() == 0)
    throw Error(where, "holds no triangles and no spheres",
                "name a scene with at least one of them; an export may have been cut off");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!finite(mesh.vertices[v]))
      throw Error(fmt::format("{}: vertex {}", where, v), "is not finite in binary32 (NaN, infinite or overflowed)",
                  "repair or scale down the model before loading it");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t index : mesh.triangles[t])
      if (index >= mesh.vertices.size())
        throw Error(fmt::format("{}: triangle {}", where, t),
                    fmt::format("names vertex {}, but there are {}", index, mesh.vertices.size()),
                    "the file is damaged or was exported wrongly");
  for (std::size_t s = 0; s < mesh.spheres.size(); ++s) {
    const Sphere& sphere = mesh.spheres[s];
    if (!(sphere.radius >= 0) || !finite(lower_corner(sphere)) || !finite(upper_corner(sphere)))
      throw Error(fmt::format("{}: sphere {}", where, s), "is not finite in binary32, or its radius is no size",
                  "repair or scale down the model before loading it");
  }
}

// The cross product of two edges in binary64: the edges are exact or nearly so, and a triangle that the file gives with
// equal or exactly aligned corners comes out as exact zeros.
bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ux = double{b.x} - a.x, uy = double{b.y} - a.y, uz = double{b.z} - a.z;
  const double vx = double{c.x} - a.x, vy = double{c.y} - a.y, vz = double{c.z} - a.z;
  return uy * vz == uz * vy && uz * vx == ux * vz && ux * vy == uy * vx;
}

// At least doubles: scenes of many small parts would be copied at each of them otherwise.
template <class Item>
void grow(std::vector<Item>& items, std::uint64_t more) {
  const std::uint64_t needed = items.size() + more;
  if (needed > items.capacity()) items.reserve(std::max<std::uint64_t>(needed, 2 * items.capacity()));
}

void report_left_out(Draft& draft, const std::string& where) {
  draft.left_out.resize(draft.options.without.size());
  for (std::size_t i = 0; i < draft.left_out.size(); ++i) {
    const std::string& pattern = draft.options.without[i];
    if (draft.left_out[i] == 0)
      throw Error(where, fmt::format("names no file '{}' that could be left out", pattern),
                  "give the name of a file that the scene names, without its folder; * stands for any letters");
    draft.warn(fmt::format("'{}' was left out", pattern), draft.left_out[i]);
  }
}

void measure(Scene& scene) {
  measure_bounds(scene);
  const auto& vertices = scene.mesh.vertices;
  for (const auto& [a, b, c] : scene.mesh.triangles)
    scene.report.zero_area_triangles += has_no_area(vertices[a], vertices[b], vertices[c]);
}

}  // namespace

void Draft::warn(const std::string& text, std::uint64_t times) {
  for (auto& [known, so_far] : warnings)
    if (known == text) {
      so_far += times;
      return;
    }
  if (warnings.size() < kMostWarnings)
    warnings.emplace_back(text, times);
  else if (warnings.size() == kMostWarnings)
    warnings.emplace_back("further warnings are left out", 1);
}

void Draft::add_format(const std::string& format) {
  if (report.format.find(format) != std::string::npos) return;
  if (!report.format.empty()) report.format += '+';
  report.format += format;
}

void Draft::require_room(const Place& where, std::uint64_t more_vertices, std::uint64_t more_triangles) {
  if (more_vertices > kMostVertices - mesh.vertices.size() || more_triangles > kMostTriangles - mesh.primitives())
    throw Error(where.text(),
                fmt::format("brings the scene to more than {} triangles or {} vertices", kMostTriangles, kMostVertices),
                "load a part of the scene");
  grow(mesh.vertices, more_vertices);
  grow(mesh.triangles, more_triangles);
}

void Draft::require_room_for_spheres(const Place& where, std::uint64_t more) {
  if (more > kMostTriangles - mesh.primitives())
    throw Error(where.text(), fmt::format("brings the scene to more than {} triangles and spheres", kMostTriangles),
                "load a part of the scene");
  grow(mesh.spheres, more);
}

bool Draft::leaves_out(const std::string& file) {
  left_out.resize(options.without.size());
  const std::string name = std::filesystem::path(file).filename().string();
  for (std::size_t i = 0; i < left_out.size(); ++i)
    if (fnmatch(options.without[i].c_str(), name.c_str(), 0) == 0) {
      ++left_out[i];
      return true;
    }
  return false;
}

Scene finish(Draft&& draft, const std::string& name, const std::string& where) {
  report_left_out(draft, where);
  check_mesh(draft.mesh, where);
  Scene scene;
  scene.name = name;
  scene.mesh = std::move(draft.mesh);
  scene.report = std::move(draft.report);
  measure(scene);
  for (const auto& [text, times] : draft.warnings)
    scene.report.warnings.push_back(times == 1 ? text : fmt::format("{} ({} times)", text, times));
  scene.camera = draft.camera ? *draft.camera : default_camera(scene);
  return scene;
}

}  // namespace ctu::scene
