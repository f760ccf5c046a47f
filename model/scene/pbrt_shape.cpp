#include "model/scene/pbrt_shape.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/base/error.h"
#include "model/scene/loop_subdivision.h"
#include "model/scene/readers.h"
#include "model/scene/resolve.h"

namespace ctu::scene {
namespace {

constexpr const char* kCorrect = "correct the line";

[[noreturn]] void refuse(std::string_view kind, const PbrtText& text) {
  text.fail(fmt::format("the shape '{}' is not read", kind.substr(0, 40)), "give it as a trianglemesh or plymesh");
}

void ply_mesh(PbrtText& text, const std::filesystem::path& folder, Draft& target) {
  for (const PbrtParameter& p : text.parameters({"filename"})) {
    if (p.name != "filename") continue;
    if (p.values.size() != 1) throw Error(p.where.text(), "one file name is wanted", kCorrect);
    if (const auto path = resolve(folder, std::string(p.values[0]), p.where, target))
      append_ply(read_source(*path), target);
    return;
  }
  text.fail("a plymesh without a filename", kCorrect);
}

void append_points(const PbrtParameter& p, Draft& target) {
  if (p.values.size() % 3 != 0)
    throw Error(p.where.text(), fmt::format("{} numbers are no whole number of points", p.values.size()), kCorrect);
  target.require_room(p.where, p.values.size() / 3, 0);
  for (std::size_t i = 0; i < p.values.size(); i += 3) {
    Vec3 v;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = p.values[i + static_cast<std::size_t>(axis)];
      if (!parse_number(word, v[axis]))
        throw Error(p.where.text(), fmt::format("'{}' is not a finite binary32 number", word.substr(0, 40)), kCorrect);
    }
    target.mesh.vertices.push_back(v);
  }
}

void append_indices(const PbrtParameter& p, std::size_t base, std::size_t points, Draft& target) {
  if (p.values.size() % 3 != 0)
    throw Error(p.where.text(), fmt::format("{} indices are no whole number of triangles", p.values.size()), kCorrect);
  target.require_room(p.where, 0, p.values.size() / 3);
  for (std::size_t i = 0; i < p.values.size(); i += 3) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      double index = -1;
      if (!parse_number(p.values[i + c], index) || index < 0 || index >= static_cast<double>(points) ||
          index != std::floor(index))
        throw Error(p.where.text(),
                    fmt::format("index '{}' names none of the {} points", p.values[i + c].substr(0, 40), points),
                    kCorrect);
      triangle[c] = static_cast<std::uint32_t>(base + static_cast<std::size_t>(index));
    }
    target.mesh.triangles.push_back(triangle);
  }
}

void triangle_mesh(PbrtText& text, Draft& target) {
  const std::size_t base = target.mesh.vertices.size();
  bool has_points = false;
  const PbrtParameter* indices = nullptr;
  const std::vector<PbrtParameter> parameters = text.parameters({"P", "indices"});
  for (const PbrtParameter& p : parameters) {
    if (p.name == "indices") indices = &p;
    if (p.name != "P") continue;
    append_points(p, target);
    has_points = true;
  }
  if (!has_points) text.fail("a trianglemesh without points \"P\"", kCorrect);
  const std::size_t points = target.mesh.vertices.size() - base;
  if (indices != nullptr) return append_indices(*indices, base, points, target);
  if (points != 3) text.fail("a trianglemesh without indices must have three points", kCorrect);
  const auto first = static_cast<std::uint32_t>(base);
  target.mesh.triangles.push_back({first, first + 1, first + 2});
}

/// The one number of a parameter.
double number_of(const PbrtParameter& p) {
  double value = 0;
  if (p.values.size() != 1 || !parse_number(p.values[0], value))
    throw Error(p.where.text(), "one finite number is wanted", kCorrect);
  return value;
}

/// "sphere": about the origin, and whole.
void sphere(PbrtText& text, Draft& target) {
  double radius = 1;
  const std::vector<PbrtParameter> parameters = text.parameters({"radius", "zmin", "zmax", "phimax"});
  for (const PbrtParameter& p : parameters)
    if (p.name == "radius") radius = number_of(p);
  for (const PbrtParameter& p : parameters)
    if ((p.name == "zmin" && number_of(p) > -radius) || (p.name == "zmax" && number_of(p) < radius) ||
        (p.name == "phimax" && number_of(p) < 360))
      throw Error(p.where.text(), "a part of a sphere; only whole ones are read", "give it as triangles");
  if (!(radius >= 0)) text.fail("a sphere of negative radius", kCorrect);
  target.require_room_for_spheres(text.where(), 1);
  target.mesh.spheres.push_back({{0, 0, 0}, static_cast<float>(radius)});
}

int levels_of(const std::vector<PbrtParameter>& parameters) {
  constexpr int kDefault = 3, kMost = 6;  // 4,096 triangles for each: a small file may not ask for all memory
  for (const PbrtParameter& p : parameters) {
    if (p.name != "nlevels" && p.name != "levels") continue;
    const double levels = number_of(p);
    if (!(levels >= 0 && levels <= kMost && levels == std::floor(levels)))
      throw Error(p.where.text(), "a number of subdivision levels that is not one",
                  fmt::format("choose 0 to {}", kMost));
    return static_cast<int>(levels);
  }
  return kDefault;
}

/// "loopsubdiv": the control mesh, so many levels finer, its vertices moved onto the limit surface as pbrt does.
void loop_surface(PbrtText& text, Draft& target) {
  const std::vector<PbrtParameter> parameters = text.parameters({"P", "indices", "nlevels", "levels"});
  const int levels = levels_of(parameters);
  Draft control;
  const PbrtParameter* indices = nullptr;
  for (const PbrtParameter& p : parameters) {
    if (p.name == "indices") indices = &p;
    if (p.name == "P") append_points(p, control);
  }
  if (indices == nullptr || control.mesh.vertices.empty())
    text.fail("a loopsubdiv without points \"P\" or \"indices\"", kCorrect);
  append_indices(*indices, 0, control.mesh.vertices.size(), control);

  ControlMesh mesh;
  for (const Vec3& vertex : control.mesh.vertices) mesh.vertices.emplace_back(vertex);
  mesh.triangles = std::move(control.mesh.triangles);
  // Six levels of whatever a file can hold stay far below 2^64. Vertices are no more than corners of triangles.
  const std::uint64_t parts = std::uint64_t{1} << (2 * levels);
  const std::uint64_t triangles = mesh.triangles.size() * parts;
  target.require_room(text.where(), triangles > kMostTriangles ? 0 : mesh.vertices.size(), triangles);
  for (int level = 0; level < levels; ++level) mesh = subdivide_loop(mesh, text.where());
  mesh = on_limit_surface(mesh, text.where());

  const auto base = static_cast<std::uint32_t>(target.mesh.vertices.size());
  for (const Vector64& vertex : mesh.vertices) target.mesh.vertices.push_back(vertex.rounded());
  for (const auto& [a, b, c] : mesh.triangles) target.mesh.triangles.push_back({base + a, base + b, base + c});
}

}  // namespace

void append_pbrt_shape(PbrtText& text, const std::filesystem::path& folder, Draft& target) {
  const std::string_view kind = text.quoted("a shape's name");
  if (kind == "plymesh") return ply_mesh(text, folder, target);
  if (kind == "trianglemesh") return triangle_mesh(text, target);
  if (kind == "loopsubdiv") return loop_surface(text, target);
  if (kind == "sphere") return sphere(text, target);
  refuse(kind, text);
}

}  // namespace ctu::scene
