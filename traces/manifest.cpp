#include "traces/manifest.h"

#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/accel/forest.h"
#include "model/base/error.h"
#include "model/reference/entry_list.h"
#include "traces/file.h"

namespace ctu::traces {
namespace {

using Json = nlohmann::ordered_json;

// --- to JSON -----------------------------------------------------------------------------------------------------

Json to_json_value(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

/// Binary32 as its bits, for values that may be infinite.
std::string hex_bits(float value) { return fmt::format("0x{:08x}", std::bit_cast<std::uint32_t>(value)); }

Json to_json_value(const intersect::Hit& hit) {
  return {{"t", hex_bits(hit.t)}, {"u", hex_bits(hit.u)}, {"v", hex_bits(hit.v)}, {"primitive", hit.primitive}};
}

Json to_json_value(const SceneInfo& scene) {
  Json json = {{"name", scene.name},
               {"hash", scene.hash},
               {"format", scene.report.format},
               {"strand_thickness", scene.strand_thickness},
               {"triangles", scene.triangles},
               {"zero_area_triangles", scene.report.zero_area_triangles},
               {"strands", scene.report.strands},
               {"segments", scene.report.segments},
               {"instances", scene.report.instances},
               {"warnings", scene.report.warnings},
               {"camera",
                {{"eye", to_json_value(scene.camera.eye)},
                 {"target", to_json_value(scene.camera.target)},
                 {"up", to_json_value(scene.camera.up)},
                 {"vertical_fov_degrees", scene.camera.vertical_fov_degrees},
                 {"from_file", scene.camera.from_file}}}};
  if (scene.spheres != 0) json["spheres"] = scene.spheres;
  return json;
}

Json to_json_value(const RayOptions& rays) {
  Json json = {{"kind", to_string(rays.kind)},
               {"width", rays.width},
               {"height", rays.height},
               {"samples_per_pixel", rays.samples_per_pixel},
               {"bounces", rays.bounces},
               {"seed", rays.seed},
               {"skip_primary", rays.skip_primary},
               {"jitter", rays.jitter},
               {"tiled", rays.tiled},
               {"count", rays.count},
               {"ao_radius", rays.ao_radius}};
  if (rays.light) json["light"] = to_json_value(*rays.light);
  return json;
}

Json to_json_value(const RayPackets& packets) {
  return {{"rays", packets.plan.size},
          {"most_entries", packets.plan.most_entries},
          {"forming", reference::to_string(packets.forming)},
          {"window", packets.window}};
}

Json to_json_value(const accel::BuildOptions& build) {
  return {{"max_leaf_triangles", build.max_leaf_triangles},
          {"bins", build.bins},
          {"node_cost", build.node_cost},
          {"triangle_cost", build.triangle_cost}};
}

Json to_json_value(const cull::MaskOptions& masks) {
  return {{"resolution", masks.resolution},
          {"ray_resolution", masks.ray_resolution},
          {"levels", masks.levels},
          {"entries", masks.entries},
          {"selection", cull::to_string(masks.selection)}};
}

Json to_json_value(const ImageInfo& info) {
  const accel::Image& image = info.shape;
  Json json = {{"mask_bits", image.layout.mask_bits},
               {"node_alignment_bytes", image.layout.node_alignment_bytes},
               {"triangle_alignment_bytes", image.layout.triangle_alignment_bytes},
               {"node_stride_bytes", image.node_stride_bytes},
               {"triangle_stride_bytes", image.triangle_stride_bytes},
               {"node_base", image.node_base},
               {"triangle_base", image.triangle_base},
               {"node_count", image.node_count},
               {"triangle_count", image.triangle_count},
               {"depth", image.depth},
               {"lower", to_json_value(image.lower)},
               {"upper", to_json_value(image.upper)},
               {"size_bytes", info.size_bytes}};
  if (image.layout.bare_nodes != 0) {
    json["bare_nodes"] = image.layout.bare_nodes;
    json["bare_node_stride_bytes"] = image.bare_node_stride_bytes;
  }
  if (image.layout.box_bits != accel::kFullBoxBits) json["box_bits"] = image.layout.box_bits;
  if (image.layout.primitive_boxes) json["primitive_boxes"] = true;
  if (image.sphere_count != 0) json["sphere_count"] = image.sphere_count;
  if (!image.further_roots.empty()) json["further_roots"] = image.further_roots;
  return json;
}

Json to_json_value(const DesignCounts& design) {
  const reference::Counts& counts = design.counts;
  Json json = {{"design", cull::to_string(design.design)},
               {"stored", design.stored},
               {"node_visits", counts.node_visits},
               {"triangle_tests", counts.triangle_tests},
               {"leaf_visits", counts.leaf_visits},
               {"box_hits", counts.box_hits},
               {"culled", counts.culled},
               {"uncertain", counts.uncertain},
               {"dropped", counts.dropped},
               {"different_hits", design.different_hits}};
  if (counts.boxed_out != 0) json["boxed_out"] = counts.boxed_out;
  return json;
}

Json to_json_value(const Section& section) {
  Json columns = Json::array();
  for (const Column& column : section.columns)
    columns.push_back({{"name", column.name},
                       {"type", column.type},
                       {"per", to_string(column.per)},
                       {"unit", column.unit},
                       {"description", column.description}});
  return {{"name", section.name}, {"columns", columns}};
}

Json to_json_value(const Difference& difference) {
  return {{"design", cull::to_string(difference.design)},
          {"ray", difference.ray},
          {"expected", to_json_value(difference.expected)},
          {"culled", to_json_value(difference.culled)}};
}

Json to_json_value(const CullingForecast& forecast) {
  return {{"name", forecast.name},
          {"cycles_per_ray", forecast.cycles_per_ray},
          {"intersections_per_ray", forecast.intersections_per_ray},
          {"node_bytes", forecast.node_bytes},
          {"image_bytes", forecast.image_bytes},
          {"masked_nodes", forecast.masked_nodes}};
}

template <class T>
Json to_json_list(const std::vector<T>& list) {
  Json json = Json::array();
  for (const T& item : list) json.push_back(to_json_value(item));
  return json;
}

Json to_json_value(const CullingChoice& culling) {
  return {{"choice", culling.choice},         {"why", culling.why},
          {"design", culling.design},         {"config_hash", culling.config_hash},
          {"pilot_rays", culling.pilot_rays}, {"forecasts", to_json_list(culling.forecasts)}};
}

// --- from JSON ---------------------------------------------------------------------------------------------------

/// An object of the text, with the name by which a message can point at it.
class Reader {
 public:
  Reader(const Json& json, std::string name, const std::string& path)
      : json_(json), name_(std::move(name)), path_(path) {
    if (!json.is_object()) fail("is not an object");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(path_, fmt::format("manifest: {} {}", name_, what), "record the trace again");
  }

  bool has(const char* key) const { return json_.contains(key); }

  const Json& at(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) fail(fmt::format("has no \"{}\"", key));
    return *found;
  }

  Reader object(const char* key) const { return Reader(at(key), name_ + "." + key, path_); }

  template <class Body>
  void each(const char* key, Body&& body) const {
    const Json& list = at(key);
    if (!list.is_array()) fail(fmt::format("\"{}\" is not a list", key));
    std::size_t i = 0;
    for (const Json& item : list) body(Reader(item, fmt::format("{}.{}[{}]", name_, key, i++), path_));
  }

  template <class T>
  T integer(const char* key, std::uint64_t low, std::uint64_t high) const {
    const Json& value = at(key);
    if (!value.is_number_unsigned()) fail(fmt::format("\"{}\" is not a whole number", key));
    const auto number = value.get<std::uint64_t>();
    if (number < low || number > high) fail(fmt::format("\"{}\" is {}, not in {} to {}", key, number, low, high));
    return static_cast<T>(number);
  }
  template <class T>
  void get(const char* key, T& to, std::uint64_t low = 0, std::uint64_t high = std::numeric_limits<T>::max()) const {
    to = integer<T>(key, low, high);
  }
  void get(const char* key, bool& to) const {
    const Json& value = at(key);
    if (!value.is_boolean()) fail(fmt::format("\"{}\" is not true or false", key));
    to = value.get<bool>();
  }
  void get(const char* key, std::string& to) const {
    const Json& value = at(key);
    if (!value.is_string()) fail(fmt::format("\"{}\" is not text", key));
    to = value.get<std::string>();
  }
  void get(const char* key, float& to) const { to = number(key, at(key)); }
  void get(const char* key, double& to) const {
    const Json& value = at(key);
    if (!value.is_number()) fail(fmt::format("\"{}\" is not a number", key));
    to = value.get<double>();
  }
  void get(const char* key, Vec3& to) const {
    const Json& value = at(key);
    if (!value.is_array() || value.size() != 3) fail(fmt::format("\"{}\" is not three numbers", key));
    for (int axis = 0; axis < 3; ++axis) to[axis] = number(key, value[static_cast<std::size_t>(axis)]);
  }
  void get(const char* key, std::vector<std::string>& to) const {
    const Json& value = at(key);
    if (!value.is_array()) fail(fmt::format("\"{}\" is not a list", key));
    for (const Json& item : value) {
      if (!item.is_string()) fail(fmt::format("\"{}\" holds more than text", key));
      to.push_back(item.get<std::string>());
    }
  }
  void get(const char* key, std::vector<std::uint32_t>& to) const {
    const Json& value = at(key);
    if (!value.is_array()) fail(fmt::format("\"{}\" is not a list", key));
    for (const Json& item : value) {
      if (!item.is_number_unsigned() || item.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
        fail(fmt::format("\"{}\" holds more than whole numbers of 32 bits", key));
      to.push_back(item.get<std::uint32_t>());
    }
  }
  void get_bits(const char* key, float& to) const {
    std::string text;
    get(key, text);
    if (text.size() != 10 || text.find_first_not_of("0123456789abcdef", 2) != std::string::npos || text[1] != 'x')
      fail(fmt::format("\"{}\" is not the bits of a number", key));
    to = std::bit_cast<float>(static_cast<std::uint32_t>(std::stoul(text.substr(2), nullptr, 16)));
  }
  void get(const char* key, cull::Design& to) const {
    std::string text;
    get(key, text);
    const auto design = cull::design_from_string(text);
    if (!design) fail(fmt::format("\"{}\" names no design: {}", key, text));
    to = *design;
  }
  void get(const char* key, cull::Selection& to) const {
    std::string text;
    get(key, text);
    const auto selection = cull::selection_from_string(text);
    if (!selection) fail(fmt::format("\"{}\" names no selection: {}", key, text));
    to = *selection;
  }

 private:
  float number(const char* key, const Json& value) const {
    if (!value.is_number()) fail(fmt::format("\"{}\" is not a number", key));
    const double wide = value.get<double>();
    if (!(std::abs(wide) <= std::numeric_limits<float>::max())) fail(fmt::format("\"{}\" is not in binary32", key));
    return static_cast<float>(wide);
  }

  const Json& json_;
  std::string name_;
  const std::string& path_;
};

void read(const Reader& from, SceneInfo& to) {
  from.get("name", to.name);
  from.get("hash", to.hash);
  from.get("format", to.report.format);
  from.get("strand_thickness", to.strand_thickness);
  from.get("triangles", to.triangles);
  if (from.has("spheres")) from.get("spheres", to.spheres);
  from.get("zero_area_triangles", to.report.zero_area_triangles);
  from.get("strands", to.report.strands);
  from.get("segments", to.report.segments);
  from.get("instances", to.report.instances);
  from.get("warnings", to.report.warnings);
  const Reader camera = from.object("camera");
  camera.get("eye", to.camera.eye);
  camera.get("target", to.camera.target);
  camera.get("up", to.camera.up);
  camera.get("vertical_fov_degrees", to.camera.vertical_fov_degrees);
  camera.get("from_file", to.camera.from_file);
}

void read(const Reader& from, RayOptions& to) {
  std::string kind;
  from.get("kind", kind);
  const auto rays = rays_from_string(kind);
  if (!rays) from.fail(fmt::format("\"kind\" names no rays: {}", kind));
  to.kind = *rays;
  from.get("width", to.width);
  from.get("height", to.height);
  from.get("samples_per_pixel", to.samples_per_pixel);
  from.get("bounces", to.bounces);
  from.get("seed", to.seed);
  from.get("skip_primary", to.skip_primary);
  from.get("jitter", to.jitter);
  from.get("tiled", to.tiled);
  from.get("count", to.count);
  from.get("ao_radius", to.ao_radius);
  if (from.has("light")) from.get("light", to.light.emplace());
}

void read(const Reader& from, RayPackets& to) {
  from.get("rays", to.plan.size, reference::kLeastPacket, reference::kMostPacket);
  from.get("most_entries", to.plan.most_entries, 1, reference::kMostEntries);
  from.get("window", to.window, 1);
  std::string name;
  from.get("forming", name);
  const auto forming = reference::forming_from_string(name);
  if (!forming) from.fail(fmt::format("\"forming\" names no way to form packets: {}", name));
  to.forming = *forming;
}

void read(const Reader& from, accel::BuildOptions& to) {
  from.get("max_leaf_triangles", to.max_leaf_triangles, 1, accel::kMaxLeafTriangles);
  from.get("bins", to.bins, 2);
  from.get("node_cost", to.node_cost);
  from.get("triangle_cost", to.triangle_cost);
}

void read(const Reader& from, cull::MaskOptions& to) {
  from.get("resolution", to.resolution, cull::kMinResolution, cull::kMaxResolution);
  from.get("ray_resolution", to.ray_resolution, 1, cull::kMaxRayResolution);
  from.get("levels", to.levels, 0, cull::kMaxLevels);
  from.get("entries", to.entries, 0, cull::kMaxEntries);
  from.get("selection", to.selection);
}

void read(const Reader& from, CullingForecast& to) {
  from.get("name", to.name);
  from.get("cycles_per_ray", to.cycles_per_ray);
  from.get("intersections_per_ray", to.intersections_per_ray);
  from.get("node_bytes", to.node_bytes);
  from.get("image_bytes", to.image_bytes);
  from.get("masked_nodes", to.masked_nodes);
}

void read(const Reader& from, CullingChoice& to) {
  from.get("choice", to.choice);
  from.get("why", to.why);
  from.get("design", to.design);
  from.get("config_hash", to.config_hash);
  from.get("pilot_rays", to.pilot_rays);
  from.each("forecasts", [&](const Reader& item) { read(item, to.forecasts.emplace_back()); });
}

void read(const Reader& from, ImageInfo& to) {
  accel::Image& image = to.shape;
  from.get("mask_bits", image.layout.mask_bits);
  from.get("node_alignment_bytes", image.layout.node_alignment_bytes);
  from.get("triangle_alignment_bytes", image.layout.triangle_alignment_bytes);
  from.get("node_stride_bytes", image.node_stride_bytes);
  from.get("triangle_stride_bytes", image.triangle_stride_bytes);
  from.get("node_base", image.node_base);
  from.get("triangle_base", image.triangle_base);
  from.get("node_count", image.node_count);
  from.get("triangle_count", image.triangle_count);
  from.get("depth", image.depth);
  from.get("lower", image.lower);
  from.get("upper", image.upper);
  from.get("size_bytes", to.size_bytes);
  if (from.has("bare_nodes")) {
    from.get("bare_nodes", image.layout.bare_nodes);
    from.get("bare_node_stride_bytes", image.bare_node_stride_bytes);
  }
  if (from.has("box_bits")) from.get("box_bits", image.layout.box_bits);
  if (from.has("primitive_boxes")) from.get("primitive_boxes", image.layout.primitive_boxes);
  if (from.has("sphere_count")) from.get("sphere_count", image.sphere_count);
  if (from.has("further_roots")) from.get("further_roots", image.further_roots);
}

void read(const Reader& from, DesignCounts& to) {
  from.get("design", to.design);
  from.get("stored", to.stored);
  from.get("node_visits", to.counts.node_visits);
  from.get("triangle_tests", to.counts.triangle_tests);
  from.get("leaf_visits", to.counts.leaf_visits);
  from.get("box_hits", to.counts.box_hits);
  from.get("culled", to.counts.culled);
  from.get("uncertain", to.counts.uncertain);
  from.get("dropped", to.counts.dropped);
  from.get("different_hits", to.different_hits);
  if (from.has("boxed_out")) from.get("boxed_out", to.counts.boxed_out);
}

void read(const Reader& from, intersect::Hit& to) {
  from.get_bits("t", to.t);
  from.get_bits("u", to.u);
  from.get_bits("v", to.v);
  from.get("primitive", to.primitive);
}

void read(const Reader& from, Difference& to) {
  from.get("design", to.design);
  from.get("ray", to.ray);
  read(from.object("expected"), to.expected);
  read(from.object("culled"), to.culled);
}

void read(const Reader& from, Section& to) {
  from.get("name", to.name);
  from.each("columns", [&](const Reader& item) {
    Column& column = to.columns.emplace_back();
    item.get("name", column.name);
    item.get("type", column.type);
    item.get("unit", column.unit);
    item.get("description", column.description);
    std::string per;
    item.get("per", per);
    for (const Per known : {Per::Ray, Per::Step, Per::Key, Per::Leaf, Per::Word, Per::Packet, Per::Visit, Per::Entry})
      if (to_string(known) == per) column.per = known;
  });
}

Manifest read_manifest(const Json& json, const std::string& path) {
  const Reader from(json, "trace", path);
  Manifest to;
  from.get("tool", to.tool);
  read(from.object("scene"), to.scene);
  read(from.object("rays"), to.rays);
  if (from.has("packets")) read(from.object("packets"), to.packets);
  if (from.has("trees")) from.object("trees").get("most_areas", to.trees.most_areas, 1, accel::kMostTrees - 1);
  read(from.object("build"), to.build);
  read(from.object("masks"), to.masks);
  if (from.has("culling")) read(from.object("culling"), to.culling);
  read(from.object("image"), to.image);
  from.get("ray_count", to.ray_count);
  from.each("designs", [&](const Reader& item) {
    std::string design;
    item.get("design", design);
    if (!cull::design_from_string(design)) return;  // one that a newer program knows
    read(item, to.designs.emplace_back());
    to.designs.back().counts.rays = to.ray_count;
  });
  from.each("differences", [&](const Reader& item) { read(item, to.differences.emplace_back()); });
  if (from.has("cut_from")) {
    from.get("cut_from", to.cut_from);
    from.get("cut_first", to.cut_first);
  }
  from.each("sections", [&](const Reader& item) { read(item, to.sections.emplace_back()); });
  return to;
}

}  // namespace

const DesignCounts* Manifest::find(cull::Design design) const {
  for (const DesignCounts& entry : designs)
    if (entry.design == design) return &entry;
  return nullptr;
}

std::uint16_t Manifest::format_minor() const {
  if (trees.any()) return kFormatMinorOfTrees;
  const bool extended = packets.any() || image.shape.sphere_count != 0 || image.shape.layout.primitive_boxes;
  return extended ? kFormatMinorOfExtensions : kFormatMinor;
}

std::string to_json(const Manifest& manifest) {
  Json json = {{"format", "ctut"},
               {"version", Json::array({kFormatMajor, manifest.format_minor()})},
               {"tool", manifest.tool},
               {"scene", to_json_value(manifest.scene)},
               {"rays", to_json_value(manifest.rays)},
               {"build", to_json_value(manifest.build)},
               {"masks", to_json_value(manifest.masks)},
               {"image", to_json_value(manifest.image)},
               {"ray_count", manifest.ray_count},
               {"designs", to_json_list(manifest.designs)},
               {"differences", to_json_list(manifest.differences)}};
  if (manifest.packets.any()) json["packets"] = to_json_value(manifest.packets);
  if (manifest.trees.any()) json["trees"] = {{"most_areas", manifest.trees.most_areas}};
  if (!manifest.culling.choice.empty()) json["culling"] = to_json_value(manifest.culling);
  if (!manifest.cut_from.empty()) {
    json["cut_from"] = manifest.cut_from;
    json["cut_first"] = manifest.cut_first;
  }
  json["sections"] = to_json_list(manifest.sections);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Manifest manifest_from_json(const std::string& text, const std::string& path) {
  try {
    return read_manifest(Json::parse(text), path);
  } catch (const nlohmann::json::exception& problem) {
    throw Error(path, fmt::format("manifest: {}", problem.what()), "record the trace again");
  }
}

std::string identity_text(const Manifest& manifest) {
  Json json = {{"format", kFormatMajor},
               {"scene", manifest.scene.hash},
               {"build", to_json_value(manifest.build)},
               {"masks", to_json_value(manifest.masks)},
               {"image", to_json_value(manifest.image)}};
  if (manifest.packets.any()) json["packets"] = to_json_value(manifest.packets);
  return json.dump();
}

}  // namespace ctu::traces
