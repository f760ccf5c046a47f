// glTF 2.0 and GLB through tinygltf, which checks little: every index, offset and count that it hands out is checked
// here before it is used. Textures are not read, skins and animations not applied.
#include <tiny_gltf.h>

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <vector>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "model/scene/affine.h"
#include "model/scene/gltf_check.h"
#include "model/scene/readers.h"

namespace ctu::scene {
namespace {

constexpr const char* kDamaged = "the file is damaged or was exported wrongly: export it again";
constexpr int kDeepestNode = 1000;

/// Files that a glTF names are read as ours are; together no more than a scene file may hold.
struct NamedFiles {
  static constexpr std::uint64_t kMostBytes = std::uint64_t{8} << 30;
  std::uint64_t bytes_left = kMostBytes;

  static bool exists(const std::string& path, void*) {
    std::error_code unreadable;
    return std::filesystem::exists(path, unreadable);
  }
  static std::string unchanged(const std::string& path, void*) { return path; }
  static bool read(std::vector<unsigned char>* to, std::string* problem, const std::string& path, void* self) {
    std::uint64_t& left = static_cast<NamedFiles*>(self)->bytes_left;
    try {
      const std::string content = read_file(path, left, "split the scene");
      left -= content.size();
      to->assign(content.begin(), content.end());
      return true;
    } catch (const Error& refusal) {
      *problem += refusal.where() + ": " + refusal.problem();
      return false;
    }
  }
};

bool ignore_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

tinygltf::Model parse(const SourceFile& file, bool binary) {
  if (file.bytes.size() > std::numeric_limits<unsigned int>::max())
    throw Error(file.path, "is larger than 4 GiB", "keep the geometry in a .bin file");
  binary ? check_glb(file) : check_gltf(file);
  NamedFiles files;
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(ignore_image, nullptr);
  reader.SetFsCallbacks({NamedFiles::exists, NamedFiles::unchanged, NamedFiles::read, nullptr, &files});
  tinygltf::Model model;
  std::string problem, warning;
  const auto bytes = static_cast<unsigned int>(file.bytes.size());
  const std::string folder = file.folder.empty() ? "." : file.folder.string();
  bool good = false;
  try {
    good = binary
               ? reader.LoadBinaryFromMemory(&model, &problem, &warning,
                                             reinterpret_cast<const unsigned char*>(file.bytes.data()), bytes, folder)
               : reader.LoadASCIIFromString(&model, &problem, &warning, file.bytes.data(), bytes, folder);
  } catch (const std::logic_error& refusal) {  // std::out_of_range and the like, for sizes of zero
    problem += refusal.what();
  }
  while (!problem.empty() && problem.back() == '\n') problem.pop_back();
  if (!good) throw Error(file.path, problem.empty() ? "is no glTF file" : "is no glTF file: " + problem, kDamaged);
  return model;
}

class GltfReader {
 public:
  GltfReader(const SourceFile& file, const tinygltf::Model& model, Draft& draft)
      : file_(file), model_(model), draft_(draft), seen_(model.nodes.size(), false) {}

  void run() {
    for (const int root : roots()) node(root, Affine{}, 0);
    if (!model_.skins.empty()) draft_.warn("gltf: skins are not applied; the mesh is read as it was modelled");
  }

 private:
  // The nodes of the default scene; without scenes, all nodes that are nobody's child.
  std::vector<int> roots() const {
    if (!model_.scenes.empty()) {
      const int scene = model_.defaultScene < 0 ? 0 : model_.defaultScene;
      return item(model_.scenes, scene, "scene").nodes;
    }
    std::vector<bool> is_child(model_.nodes.size(), false);
    for (const auto& n : model_.nodes)
      for (const int child : n.children)
        if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
          is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> all;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) all.push_back(static_cast<int>(i));
    return all;
  }

  void node(int index, const Affine& parent, int depth) {
    const tinygltf::Node& n = item(model_.nodes, index, "node");
    const std::string where = fmt::format("{}: node {}", file_.path, index);
    if (seen_[static_cast<std::size_t>(index)]) throw Error(where, "is reached twice; nodes form a tree", kDamaged);
    if (depth > kDeepestNode) throw Error(where, fmt::format("is nested more than {} deep", kDeepestNode), kDamaged);
    seen_[static_cast<std::size_t>(index)] = true;
    const Affine to_world = parent * local_transform(n, where);
    if (n.mesh >= 0) mesh(n.mesh, to_world);
    if (n.camera >= 0) camera(n.camera, to_world);
    for (const int child : n.children) node(child, to_world, depth + 1);
  }

  static Affine local_transform(const tinygltf::Node& n, const std::string& where) {
    if (n.matrix.size() == 16) {
      std::array<double, 16> numbers;
      std::copy(n.matrix.begin(), n.matrix.end(), numbers.begin());
      const auto matrix = from_columns(numbers);
      if (!matrix) throw Error(where, "its matrix is a projection: the last row is not 0 0 0 1", kDamaged);
      return *matrix;
    }
    const bool well_formed = n.matrix.empty() && (n.translation.empty() || n.translation.size() == 3) &&
                             (n.rotation.empty() || n.rotation.size() == 4) && (n.scale.empty() || n.scale.size() == 3);
    if (!well_formed) throw Error(where, "its transform has the wrong number of numbers", kDamaged);
    Affine result;
    if (!n.translation.empty()) result = translation({n.translation[0], n.translation[1], n.translation[2]});
    if (!n.rotation.empty()) {
      const auto turned = rotation({n.rotation[0], n.rotation[1], n.rotation[2], n.rotation[3]});
      if (!turned) throw Error(where, "its rotation is zero or not finite", kDamaged);
      result = result * *turned;
    }
    if (!n.scale.empty()) result = result * scaling({n.scale[0], n.scale[1], n.scale[2]});
    return result;
  }

  void mesh(int index, const Affine& to_world) {
    const auto& primitives = item(model_.meshes, index, "mesh").primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p)
      primitive(primitives[p], to_world, fmt::format("{}: mesh {}, primitive {}", file_.path, index, p));
  }

  void primitive(const tinygltf::Primitive& p, const Affine& to_world, const std::string& where) {
    const int mode = p.mode < 0 ? TINYGLTF_MODE_TRIANGLES : p.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) return draft_.warn("gltf: points and lines are not triangles and were skipped");
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) throw Error(where, fmt::format("unknown mode {}", mode), kDamaged);
    const auto position = p.attributes.find("POSITION");
    if (position == p.attributes.end()) return draft_.warn("gltf: a primitive without positions was skipped");
    const std::uint64_t base = draft_.mesh.vertices.size();
    append_positions(position->second, to_world, where);
    append_triangles(corners(p, draft_.mesh.vertices.size() - base, where), mode, base, where);
  }

  // An accessor whose every element is known to lie inside its buffer.
  struct View {
    const unsigned char* first = nullptr;
    std::size_t stride = 0, count = 0;
    int component = 0;
  };

  View view_of(int index, int type, const std::string& where) const {
    const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
    const std::string here = fmt::format("{}, accessor {}", where, index);
    if (accessor.sparse.isSparse || accessor.bufferView < 0)
      throw Error(here, "is sparse or compressed, which is not read",
                  "export plain buffers (no Draco, no sparse accessors)");
    if (accessor.type != type) throw Error(here, "has the wrong type", kDamaged);
    const tinygltf::BufferView& slice = item(model_.bufferViews, accessor.bufferView, "bufferView");
    const auto& data = item(model_.buffers, slice.buffer, "buffer").data;
    const int item_bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)) *
                           tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
    const int stride = accessor.ByteStride(slice);
    if (item_bytes <= 0 || stride < item_bytes) throw Error(here, "has an unknown component type or stride", kDamaged);
    const std::size_t bytes = static_cast<std::size_t>(item_bytes), step = static_cast<std::size_t>(stride);
    if (slice.byteOffset > data.size() || slice.byteLength > data.size() - slice.byteOffset ||
        accessor.byteOffset > slice.byteLength)
      throw Error(here, "begins outside its buffer", kDamaged);
    const std::size_t room = slice.byteLength - accessor.byteOffset;
    if (accessor.count == 0) return {};
    if (bytes > room || accessor.count - 1 > (room - bytes) / step)
      throw Error(
          here, fmt::format("its {} elements do not fit its buffer view of {} bytes", accessor.count, slice.byteLength),
          kDamaged);
    return {data.data() + slice.byteOffset + accessor.byteOffset, step, accessor.count, accessor.componentType};
  }

  void append_positions(int accessor, const Affine& to_world, const std::string& where) {
    const View view = view_of(accessor, TINYGLTF_TYPE_VEC3, where);
    if (view.count != 0 && view.component != TINYGLTF_COMPONENT_TYPE_FLOAT)
      throw Error(where, "positions are not binary32 (quantized meshes are not read)", "export plain float positions");
    draft_.require_room(where, view.count, 0);
    for (std::size_t i = 0; i < view.count; ++i) {
      Vec3 v;
      std::memcpy(&v, view.first + i * view.stride, sizeof(v));
      const Vec3 placed = to_world == Affine{} ? v : to_world.vertex(v);
      if (!std::isfinite(placed.x) || !std::isfinite(placed.y) || !std::isfinite(placed.z))
        throw Error(fmt::format("{}, vertex {}", where, i), "a coordinate is NaN, infinite or too large",
                    "repair the model before loading it");
      draft_.mesh.vertices.push_back(placed);
    }
  }

  // Without indices, the vertices in their order.
  std::vector<std::uint32_t> corners(const tinygltf::Primitive& p, std::uint64_t vertices,
                                     const std::string& where) const {
    std::vector<std::uint32_t> result;
    if (p.indices < 0) {
      for (std::uint32_t i = 0; i < vertices; ++i) result.push_back(i);
      return result;
    }
    const View view = view_of(p.indices, TINYGLTF_TYPE_SCALAR, where);
    result.reserve(view.count);
    for (std::size_t i = 0; i < view.count; ++i) {
      const std::uint32_t index = index_at(view, i, where);
      if (index >= vertices)
        throw Error(fmt::format("{}, index {}", where, i),
                    fmt::format("names vertex {}, but there are {}", index, vertices), kDamaged);
      result.push_back(index);
    }
    return result;
  }

  static std::uint32_t index_at(const View& view, std::size_t i, const std::string& where) {
    const unsigned char* at = view.first + i * view.stride;
    std::uint16_t two;
    std::uint32_t four;
    switch (view.component) {
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return *at;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return std::memcpy(&two, at, 2), two;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return std::memcpy(&four, at, 4), four;
      default:
        throw Error(where, "indices are not unsigned integers", kDamaged);
    }
  }

  // Lists, strips (every second triangle turned to keep its side) and fans.
  void append_triangles(const std::vector<std::uint32_t>& c, int mode, std::uint64_t base64, const std::string& where) {
    const auto base = static_cast<std::uint32_t>(base64);
    const bool list = mode == TINYGLTF_MODE_TRIANGLES;
    draft_.require_room(where, 0, list ? c.size() / 3 : c.size());
    if (list && c.size() % 3 != 0)
      throw Error(where, fmt::format("{} corners are no whole number of triangles", c.size()), kDamaged);
    for (std::size_t i = 2; i < c.size(); i += list ? 3 : 1) {
      const bool turned = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1;
      const std::uint32_t a = mode == TINYGLTF_MODE_TRIANGLE_FAN ? c[0] : c[i - 2];
      draft_.mesh.triangles.push_back({base + (turned ? c[i - 1] : a), base + (turned ? a : c[i - 1]), base + c[i]});
    }
  }

  // A camera looks along its -z with y up.
  void camera(int index, const Affine& to_world) {
    const tinygltf::Camera& stated = item(model_.cameras, index, "camera");
    if (draft_.camera || stated.type != "perspective") return;
    const double degrees = stated.perspective.yfov * 180 / 3.14159265358979323846;
    if (!(degrees > 0 && degrees < 180))
      return draft_.warn("gltf: a camera with a field of view outside (0, pi) was skipped");
    Camera c;
    c.eye = to_world.point({0, 0, 0}).rounded();
    c.target = to_world.point({0, 0, -1}).rounded();
    c.up = to_world.direction({0, 1, 0}).rounded();
    c.vertical_fov_degrees = static_cast<float>(degrees);
    c.from_file = true;
    draft_.camera = c;
  }

  template <class Item>
  const Item& item(const std::vector<Item>& items, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= items.size())
      throw Error(file_.path, fmt::format("names {} {}, but there are {}", what, index, items.size()), kDamaged);
    return items[static_cast<std::size_t>(index)];
  }

  const SourceFile& file_;
  const tinygltf::Model& model_;
  Draft& draft_;
  std::vector<bool> seen_;
};

void read_either(const SourceFile& file, bool binary, Draft& draft) {
  draft.add_format("gltf");
  const tinygltf::Model model = parse(file, binary);
  GltfReader(file, model, draft).run();
}

}  // namespace

void read_gltf(const SourceFile& file, Draft& draft) { read_either(file, false, draft); }
void read_glb(const SourceFile& file, Draft& draft) { read_either(file, true, draft); }

}  // namespace ctu::scene
