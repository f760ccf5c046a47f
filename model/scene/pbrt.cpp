// The geometry of pbrt-v3 scenes: triangle meshes, PLY meshes, Loop subdivision surfaces, spheres, transforms,
// instances (flattened) and the camera. Source: pbrt.org/fileformat-v3. Materials, textures, lights and film are passed
// over by name; other shapes are refused, and so is a statement that nobody knows, since a misspelt transform would
// move the scene.
#include <fmt/core.h>

#include <algorithm>
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
#include "model/scene/pbrt_matrix.h"
#include "model/scene/pbrt_shape.h"
#include "model/scene/pbrt_text.h"
#include "model/scene/readers.h"
#include "model/scene/resolve.h"

namespace ctu::scene {
namespace {

constexpr std::size_t kDeepestInclude = 32;
constexpr std::uint64_t kMostIncludes = 100'000;
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

/// A shape of an object: ranges of vertices, triangles and spheres, and the matrix at its definition.
struct Part {
  std::size_t first_vertex, last_vertex, first_triangle, last_triangle, first_sphere, last_sphere;
  Affine placement;
};

/// The sphere under a map that keeps angles, which those of text files do to about six digits. Throws Error at `where`
/// for others: they make an ellipsoid of it.
Sphere moved(const Sphere& sphere, const Affine& placement, const Place& where) {
  constexpr double kDigits = 1e-5;
  const Vector64 column[3] = {placement.direction({1, 0, 0}), placement.direction({0, 1, 0}),
                              placement.direction({0, 0, 1})};
  const double scale = length(column[0]), square = scale * scale;
  for (int i = 0; i < 3; ++i)
    if (!(std::fabs(dot(column[i], column[i]) - square) <= kDigits * square) ||
        !(std::fabs(dot(column[i], column[(i + 1) % 3])) <= kDigits * square))
      throw Error(where.text(), "a sphere under a transform that makes an ellipsoid of it",
                  "scale it evenly, or give it as triangles");
  return {placement.vertex(sphere.centre), static_cast<float>(scale * sphere.radius)};
}

/// Copies a part with its vertices and spheres moved by `placement`.
void append_moved(const Mesh& from, const Part& part, const Affine& placement, const Place& where, Mesh& to) {
  for (std::size_t s = part.first_sphere; s < part.last_sphere; ++s)
    to.spheres.push_back(moved(from.spheres[s], placement, where));
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
      : folder_(folder), camera_only_(camera_only), draft_(draft), matrix_(draft) {
    library_.options = draft.options;
  }

  void run(const SourceFile& file) {
    std::error_code unreadable;
    const auto here = std::filesystem::weakly_canonical(file.path, unreadable);
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
    for (const auto& [warning, times] : library_.warnings) draft_.warn(warning, times);
    draft_.left_out.resize(draft_.options.without.size());
    for (std::size_t i = 0; i < library_.left_out.size(); ++i) draft_.left_out[i] += library_.left_out[i];
  }

 private:
  struct Object {
    std::vector<Part> parts;
  };
  struct Statement {
    const char* name;
    void (PbrtReader::*obey)(PbrtText&);
  };
  static const std::vector<Statement> kStructure;

  void statement(PbrtText& text) {
    const std::string_view name = text.statement();
    if (matrix_.take(name, text)) return;
    for (const auto& [known, obey] : kStructure)
      if (name == known) return (this->*obey)(text);
    const auto& known = passed_over();
    if (std::find(known.begin(), known.end(), name) == known.end()) unknown(name, text);
    text.skip_arguments();
  }

  [[noreturn]] static void unknown(std::string_view name, const PbrtText& text) {
    std::vector<std::string> known = passed_over();
    known.insert(known.end(), PbrtMatrix::statements().begin(), PbrtMatrix::statements().end());
    for (const auto& own : kStructure) known.emplace_back(own.name);
    text.fail(fmt::format("unknown statement '{}'", name.substr(0, 40)),
              fmt::format("did you mean {}? The file must be pbrt version 3", nearest_name(name.substr(0, 40), known)));
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
      draft_.require_room_for_spheres(text.where(), part.last_sphere - part.first_sphere);
      append_moved(library_.mesh, part, matrix_.current() * part.placement, text.where(), draft_.mesh);
    }
  }

  void shape(PbrtText& text) {
    Draft& target = object_ != nullptr ? library_ : draft_;
    Part part{target.mesh.vertices.size(),
              0,
              target.mesh.triangles.size(),
              0,
              target.mesh.spheres.size(),
              0,
              matrix_.current()};
    append_pbrt_shape(text, folder_, target);
    part.last_vertex = target.mesh.vertices.size();
    part.last_triangle = target.mesh.triangles.size();
    part.last_sphere = target.mesh.spheres.size();
    if (object_ != nullptr) return object_->parts.push_back(part);
    if (part.placement == Affine{}) return;
    for (std::size_t v = part.first_vertex; v < part.last_vertex; ++v)
      target.mesh.vertices[v] = part.placement.vertex(target.mesh.vertices[v]);
    for (std::size_t s = part.first_sphere; s < part.last_sphere; ++s)
      target.mesh.spheres[s] = moved(target.mesh.spheres[s], part.placement, text.where());
  }

  void camera(PbrtText& text) {
    const std::string_view kind = text.quoted("a camera's name");
    double fov = 90;
    for (const PbrtParameter& p : text.parameters({"fov"}))
      if (p.name == "fov" && (p.values.size() != 1 || !parse_number(p.values[0], fov) || !(fov > 0 && fov < 180)))
        throw Error(p.where.text(), "a field of view outside (0, 180) degrees", kCorrect);
    const auto to_world = inverse(matrix_.current());
    if (!to_world) text.fail("the camera's matrix is singular", kCorrect);
    matrix_.remember("camera", *to_world);
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

  void world_begin(PbrtText&) {
    matrix_.begin_world();
    done_ = camera_only_;
  }
  void world_end(PbrtText&) { done_ = true; }
  void push(PbrtText& text) { matrix_.push(text); }
  void pop(PbrtText& text) { matrix_.pop(text); }

  const std::filesystem::path folder_;
  const bool camera_only_;
  Draft& draft_;
  PbrtMatrix matrix_;
  Draft library_;  ///< the parts of objects, not yet placed
  std::map<std::string, Object, std::less<>> objects_;
  Object* object_ = nullptr;
  std::vector<std::filesystem::path> open_files_;
  std::uint64_t includes_ = 0;
  bool done_ = false;
  std::optional<Affine> camera_;
  double fov_ = 90;
};

const std::vector<PbrtReader::Statement> PbrtReader::kStructure = {
    {"AttributeBegin", &PbrtReader::push},      {"AttributeEnd", &PbrtReader::pop},
    {"TransformBegin", &PbrtReader::push},      {"TransformEnd", &PbrtReader::pop},
    {"ObjectBegin", &PbrtReader::object_begin}, {"ObjectEnd", &PbrtReader::object_end},
    {"ObjectInstance", &PbrtReader::instance},  {"Shape", &PbrtReader::shape},
    {"Include", &PbrtReader::include},          {"Camera", &PbrtReader::camera},
    {"WorldBegin", &PbrtReader::world_begin},   {"WorldEnd", &PbrtReader::world_end},
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
