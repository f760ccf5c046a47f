#include "model/scene/pbrt_shape.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "model/base/error.h"
#include "model/scene/readers.h"
#include "model/scene/resolve.h"

namespace ctu::scene {
namespace {

constexpr const char* kCorrect = "correct the line";

[[noreturn]] void refuse(std::string_view kind, const PbrtText& text) {
  if (kind == "sphere") text.fail("a sphere; spheres are not read yet", "remove it, or give it as triangles");
  if (kind == "loopsubdiv")
    text.fail("a Loop subdivision surface; they are not read yet", "subdivide it in a modeller and save triangles");
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

}  // namespace

void append_pbrt_shape(PbrtText& text, const std::filesystem::path& folder, Draft& target) {
  const std::string_view kind = text.quoted("a shape's name");
  if (kind == "plymesh") return ply_mesh(text, folder, target);
  if (kind == "trianglemesh") return triangle_mesh(text, target);
  refuse(kind, text);
}

}  // namespace ctu::scene
