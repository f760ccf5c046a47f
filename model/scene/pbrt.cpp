// The geometry of pbrt-v3 scenes: triangle meshes, PLY meshes, transforms, instances (flattened) and the camera.
// Source: pbrt.org/fileformat-v3. Materials, textures, lights and film are passed over by name; shapes that are not
// triangles are refused, and so is a statement that nobody knows, since a misspelt transform would move the scene.
//
// AttributeBegin, TransformBegin and ObjectBegin push one and the same stack: San Miguel closes them in crossed order.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/base/error.h"
#include "model/base/nearest.h"
#include "model/scene/affine.h"
#include "model/scene/pbrt_text.h"
#include "model/scene/readers.h"
#include "model/scene/resolve.h"

namespace ctu::scene {
namespace {

constexpr std::size_t kDeepestInclude = 32;
constexpr std::uint64_t kMostIncludes = 100'000;
constexpr std::size_t kDeepestStack = 100'000;
constexpr const char* kCorrect = "correct the line";

// Statements whose arguments say nothing about geometry.
const std::vector<std::string>& passed_over() {
  static const std::vector<std::string> names = {
      "Accelerator", "AreaLightSource",    "ColorSpace",        "Film",
      "Integrator",  "LightSource",        "MakeNamedMaterial", "MakeNamedMedium",
      "Material",    "MediumInterface",    "NamedMaterial",     "PixelFilter",
      "Renderer",    "ReverseOrientation", "Sampler",           "SurfaceIntegrator",
      "Texture",     "TransformTimes",     "VolumeIntegrator"};
  return names;
}

/// A mesh in some Draft: ranges of its vertices and triangles.
struct Part {
  std::size_t first_vertex, last_vertex, first_triangle, last_triangle;
  Affine placement;
};

/// Copies a part with its vertices moved by `placement`.
void append_moved(const Mesh& from, const Part& part, const Affine& placement, Mesh& to) {
  const std::size_t base = to.vertices.size();
  for (std::size_t v = part.first_vertex; v < part.last_vertex; ++v)
    to.vertices.push_back(placement.vertex(from.vertices[v]));
  const auto shift = static_cast<std::uint32_t>(base - part.first_vertex);  // wraps: only the sum matters
  for (std::size_t t = part.first_triangle; t < part.last_triangle; ++t) {
    const auto& [a, b, c] = from.triangles[t];
    to.triangles.push_back({a + shift, b + shift, c + shift});
  }
}

class PbrtReader {
 public:
  PbrtReader(const std::filesystem::path& folder, bool camera_only, Draft& draft)
      : folder_(folder), camera_only_(camera_only), draft_(draft) {}

  void run(const SourceFile& file) {
    const auto here = std::filesystem::weakly_canonical(file.path);
    if (std::find(open_files_.begin(), open_files_.end(), here) != open_files_.end())
      throw Error(file.path, "includes itself, directly or through others",
                  "remove the Include that closes the circle");
    if (open_files_.size() >= kDeepestInclude)
      throw Error(file.path, fmt::format("is included more than {} deep", kDeepestInclude), "merge the files");
    open_files_.push_back(here);
    PbrtText text(file);
    while (!done_ && !text.at_end()) statement(text);
    open_files_.pop_back();
  }

  void finish() {
    if (camera_) set_camera();
    if (object_ != nullptr) draft_.warn("pbrt: the last ObjectBegin has no ObjectEnd");
  }

 private:
  struct Object {
    std::vector<Part> parts;
  };

  void statement(PbrtText& text) {
    const std::string_view name = text.statement();
    if (name == "AttributeBegin" || name == "TransformBegin") return push(text);
    if (name == "AttributeEnd" || name == "TransformEnd") return pop(text);
    if (name == "ObjectInstance") return instance(text);
    if (name == "Shape") return shape(text);
    if (transform_statement(name, text) || structure_statement(name, text)) return;
    const auto& known = passed_over();
    if (std::find(known.begin(), known.end(), name) == known.end()) unknown(name, text);
    text.skip_arguments();
  }

  bool transform_statement(std::string_view name, PbrtText& text) {
    if (name == "Identity") return set(Affine{}), true;
    if (name == "Transform") return set(matrix(text)), true;
    if (name == "ConcatTransform") return move(matrix(text)), true;
    if (name == "Translate") return move(translation(vector(text))), true;
    if (name == "Scale") return move(scaling(vector(text))), true;
    if (name == "Rotate") return rotate(text), true;
    if (name == "LookAt") return look_at(text), true;
    if (name == "CoordinateSystem") return systems_[std::string(text.quoted("a name"))] = current_, true;
    if (name == "CoordSysTransform") return coordinate_system(text), true;
    if (name == "ActiveTransform") return active_transform(text), true;
    return false;
  }

  bool structure_statement(std::string_view name, PbrtText& text) {
    if (name == "ObjectBegin") return object_begin(text), true;
    if (name == "ObjectEnd") return object_end(text), true;
    if (name == "Include") return include(text), true;
    if (name == "Camera") return camera(text), true;
    if (name == "WorldBegin") return world_begin(), true;
    if (name == "WorldEnd") return done_ = true, true;
    return false;
  }

  [[noreturn]] static void unknown(std::string_view name, const PbrtText& text) {
    std::vector<std::string> known = passed_over();
    for (const char* own :
         {"AttributeBegin", "AttributeEnd",     "TransformBegin",    "TransformEnd",    "ObjectInstance", "Shape",
          "Identity",       "Transform",        "ConcatTransform",   "Translate",       "Scale",          "Rotate",
          "LookAt",         "CoordinateSystem", "CoordSysTransform", "ActiveTransform", "ObjectBegin",    "ObjectEnd",
          "Include",        "Camera",           "WorldBegin",        "WorldEnd"})
      known.emplace_back(own);
    text.fail(fmt::format("unknown statement '{}'", name.substr(0, 40)),
              fmt::format("did you mean {}? The file must be pbrt version 3", nearest_name(name.substr(0, 40), known)));
  }

  void push(const PbrtText& text) {
    if (stack_.size() >= kDeepestStack) text.fail("blocks are nested too deep", kCorrect);
    stack_.push_back(current_);
  }
  void pop(const PbrtText& text) {
    if (stack_.empty()) text.fail("ends a block that was not begun", "remove it, or add the Begin");
    current_ = stack_.back();
    stack_.pop_back();
  }

  // Scenes with motion state transforms for the end of the exposure too; the start counts.
  void set(const Affine& matrix) {
    if (at_start_) current_ = matrix;
  }
  void move(const Affine& matrix) {
    if (at_start_) current_ = current_ * matrix;
  }
  void active_transform(PbrtText& text) {
    const std::string_view which = text.statement();
    if (which != "All" && which != "StartTime" && which != "EndTime")
      text.fail("is none of All, StartTime, EndTime", kCorrect);
    at_start_ = which != "EndTime";
    if (!at_start_) draft_.warn("pbrt: transforms of the end of a motion are left out");
  }

  static Affine matrix(PbrtText& text) {
    std::array<double, 16> numbers;
    text.numbers(numbers.data(), 16, "a matrix");
    const auto result = from_columns(numbers);
    if (!result) text.fail("the matrix is a projection: its numbers 4, 8, 12, 16 are not 0 0 0 1", kCorrect);
    return *result;
  }
  static Vector64 vector(PbrtText& text) {
    double v[3];
    text.numbers(v, 3, "a vector");
    return {v[0], v[1], v[2]};
  }
  void rotate(PbrtText& text) {
    double v[4];
    text.numbers(v, 4, "an angle and an axis");
    const auto turned = rotation(v[0], {v[1], v[2], v[3]});
    if (!turned) text.fail("rotates about a zero axis", kCorrect);
    move(*turned);
  }
  // World to camera: x = up cross direction, as pbrt has it (left-handed), y = the true up, z = the direction.
  void look_at(PbrtText& text) {
    const Vector64 eye = vector(text), target = vector(text), up = vector(text);
    const Vector64 z = normalized(target - eye, {0, 0, 0});
    const Vector64 x = normalized(cross(up, z), {0, 0, 0});
    if (length(z) == 0 || length(x) == 0) text.fail("looks at its own place, or along its up vector", kCorrect);
    const Vector64 y = cross(z, x);
    Affine to_camera;
    const Vector64 rows[3] = {x, y, z};
    for (int row = 0; row < 3; ++row) {
      to_camera.m[row][0] = rows[row].x;
      to_camera.m[row][1] = rows[row].y;
      to_camera.m[row][2] = rows[row].z;
      to_camera.m[row][3] = -dot(rows[row], eye);
    }
    move(to_camera);
  }
  void coordinate_system(PbrtText& text) {
    const std::string name(text.quoted("a name"));
    const auto found = systems_.find(name);
    if (found == systems_.end()) text.fail(fmt::format("there is no coordinate system '{}'", name), kCorrect);
    set(found->second);
  }

  void include(PbrtText& text) {
    const std::string name(text.quoted("a file's name"));
    if (++includes_ > kMostIncludes) text.fail(fmt::format("more than {} Includes", kMostIncludes), "merge the files");
    if (const auto path = resolve(folder_, name, text.where(), draft_)) run(read_source(*path));
  }

  void object_begin(PbrtText& text) {
    if (object_ != nullptr) text.fail("an object inside an object", "end the first with ObjectEnd");
    push(text);
    object_ = &objects_[std::string(text.quoted("an object's name"))];
    object_->parts.clear();
  }
  void object_end(PbrtText& text) {
    if (object_ == nullptr) text.fail("ends an object that was not begun", "remove it, or add the ObjectBegin");
    pop(text);
    object_ = nullptr;
  }
  void instance(PbrtText& text) {
    const std::string_view name = text.quoted("an object's name");
    const auto found = objects_.find(name);
    if (found == objects_.end())
      text.fail(fmt::format("there is no object '{}'", name), "define it before its instances");
    if (object_ != nullptr) text.fail("an instance inside an object", "move it out: pbrt does not nest instances");
    ++draft_.report.instances;
    for (const Part& part : found->second.parts) {
      draft_.require_room(text.where(), part.last_vertex - part.first_vertex, part.last_triangle - part.first_triangle);
      append_moved(library_.mesh, part, current_ * part.placement, draft_.mesh);
    }
  }

  void shape(PbrtText& text) {
    const std::string_view kind = text.quoted("a shape's name");
    if (kind != "trianglemesh" && kind != "plymesh") refuse(kind, text);
    Draft& target = object_ != nullptr ? library_ : draft_;
    Part part{target.mesh.vertices.size(), 0, target.mesh.triangles.size(), 0, current_};
    if (kind == "plymesh")
      ply_mesh(text, target);
    else
      triangle_mesh(text, target);
    part.last_vertex = target.mesh.vertices.size();
    part.last_triangle = target.mesh.triangles.size();
    if (object_ != nullptr)
      object_->parts.push_back(part);
    else if (!(current_ == Affine{}))
      for (std::size_t v = part.first_vertex; v < part.last_vertex; ++v)
        target.mesh.vertices[v] = current_.vertex(target.mesh.vertices[v]);
  }

  [[noreturn]] static void refuse(std::string_view kind, const PbrtText& text) {
    if (kind == "sphere") text.fail("a sphere; spheres are not read yet", "remove it, or give it as triangles");
    if (kind == "loopsubdiv")
      text.fail("a Loop subdivision surface; they are not read yet", "subdivide it in a modeller and save triangles");
    text.fail(fmt::format("the shape '{}' is not read", kind.substr(0, 40)), "give it as a trianglemesh or plymesh");
  }

  void ply_mesh(PbrtText& text, Draft& target) {
    for (const PbrtParameter& p : text.parameters({"filename"})) {
      if (p.name != "filename") continue;
      if (p.values.size() != 1) throw Error(p.where.text(), "one file name is wanted", kCorrect);
      if (const auto path = resolve(folder_, std::string(p.values[0]), p.where, draft_))
        append_ply(read_source(*path), target);
      return;
    }
    text.fail("a plymesh without a filename", kCorrect);
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

  static void append_points(const PbrtParameter& p, Draft& target) {
    if (p.values.size() % 3 != 0)
      throw Error(p.where.text(), fmt::format("{} numbers are no whole number of points", p.values.size()), kCorrect);
    target.require_room(p.where, p.values.size() / 3, 0);
    for (std::size_t i = 0; i < p.values.size(); i += 3) {
      Vec3 v;
      for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = p.values[i + static_cast<std::size_t>(axis)];
        if (!parse_number(word, v[axis]))
          throw Error(p.where.text(), fmt::format("'{}' is not a finite binary32 number", word.substr(0, 40)),
                      kCorrect);
      }
      target.mesh.vertices.push_back(v);
    }
  }

  static void append_indices(const PbrtParameter& p, std::size_t base, std::size_t points, Draft& target) {
    if (p.values.size() % 3 != 0)
      throw Error(p.where.text(), fmt::format("{} indices are no whole number of triangles", p.values.size()),
                  kCorrect);
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

  void camera(PbrtText& text) {
    const std::string_view kind = text.quoted("a camera's name");
    double fov = 90;
    for (const PbrtParameter& p : text.parameters({"fov"}))
      if (p.name == "fov" && (p.values.size() != 1 || !parse_number(p.values[0], fov) || !(fov > 0 && fov < 180)))
        throw Error(p.where.text(), "a field of view outside (0, 180) degrees", kCorrect);
    const auto to_world = inverse(current_);
    if (!to_world) text.fail("the camera's matrix is singular", kCorrect);
    systems_["camera"] = *to_world;
    if (kind != "perspective")
      return draft_.warn(fmt::format("pbrt: the camera '{}' is not perspective and was left out", kind));
    camera_ = *to_world;
    fov_ = fov;
  }

  // pbrt states the field of view across the shorter side of the film; pictures here are as wide as high or wider, so
  // it becomes the vertical one. A mirrored matrix (Scale -1 1 1) mirrors the picture but not what is seen: dropped.
  void set_camera() {
    if (draft_.camera) return;
    Camera c;
    c.eye = camera_->point({0, 0, 0}).rounded();
    c.target = camera_->point({0, 0, 1}).rounded();
    c.up = camera_->direction({0, 1, 0}).rounded();
    c.vertical_fov_degrees = static_cast<float>(fov_);
    c.from_file = true;
    draft_.camera = c;
  }

  void world_begin() {
    current_ = Affine{};
    systems_["world"] = current_;
    at_start_ = true;
    done_ = camera_only_;
  }

  const std::filesystem::path folder_;
  const bool camera_only_;
  Draft& draft_;
  Draft library_;  ///< the parts of objects, not yet placed
  std::map<std::string, Object, std::less<>> objects_;
  Object* object_ = nullptr;
  std::map<std::string, Affine> systems_;
  Affine current_;
  std::vector<Affine> stack_;
  std::vector<std::filesystem::path> open_files_;
  std::uint64_t includes_ = 0;
  bool at_start_ = true, done_ = false;
  std::optional<Affine> camera_;
  double fov_ = 90;
};

}  // namespace

void read_pbrt(const SourceFile& file, Draft& draft) {
  draft.add_format("pbrt");
  PbrtReader reader(file.folder, false, draft);
  reader.run(file);
  reader.finish();
}

void read_pbrt_camera(const SourceFile& file, Draft& draft) {
  PbrtReader reader(file.folder, true, draft);
  reader.run(file);
  reader.finish();
}

}  // namespace ctu::scene
