#include "sim/sweep/point.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "model/base/hash.h"
#include "model/base/version.h"
#include "model/pipeline/parameter.h"
#include "sim/config_file.h"
#include "sim/scene_list.h"
#include "sim/sweep/shell.h"
#include "traces/trace_reader.h"

namespace ctu::sweep {
namespace {

using nlohmann::ordered_json;

constexpr int kRowVersion = 2;  // raised when a change of the simulator or of the columns makes old rows wrong

ordered_json to_json(const TraceFacts& t) {
  return {{"name", t.name},
          {"file", t.file},
          {"hash", t.hash},
          {"scene", t.scene},
          {"ray_kind", t.ray_kind},
          {"trace_rays", t.trace_rays},
          {"triangles", t.triangles},
          {"image_bytes", t.image_bytes},
          {"r", t.r},
          {"r_ray", t.r_ray},
          {"levels", t.levels},
          {"lut_entries", t.lut_entries},
          {"box_bits", t.box_bits}};
}

TraceFacts facts_from_json(const ordered_json& json) {
  TraceFacts t;
  json.at("name").get_to(t.name);
  json.at("file").get_to(t.file);
  json.at("hash").get_to(t.hash);
  json.at("scene").get_to(t.scene);
  json.at("ray_kind").get_to(t.ray_kind);
  json.at("trace_rays").get_to(t.trace_rays);
  json.at("triangles").get_to(t.triangles);
  json.at("image_bytes").get_to(t.image_bytes);
  json.at("r").get_to(t.r);
  json.at("r_ray").get_to(t.r_ray);
  json.at("levels").get_to(t.levels);
  json.at("lut_entries").get_to(t.lut_entries);
  json.at("box_bits").get_to(t.box_bits);
  return t;
}

}  // namespace

TraceFacts read_trace_facts(const std::string& name, const std::string& file, const std::string& scene) {
  const traces::TraceReader reader(file);
  const traces::Manifest& m = reader.manifest();
  TraceFacts facts;
  facts.name = name;
  facts.file = file;
  facts.hash = reader.hash();
  facts.scene = scene.empty() ? sim::short_name(m.scene.name) : scene;
  facts.ray_kind = traces::to_string(m.rays.kind);
  facts.trace_rays = reader.rays();
  facts.triangles = m.scene.triangles;
  facts.image_bytes = m.image.size_bytes;
  facts.box_bits = m.image.shape.layout.box_bits;
  if (m.image.shape.layout.mask_bits != 0) {
    facts.r = m.masks.resolution;
    facts.r_ray = m.masks.ray_resolution;
    facts.levels = m.masks.levels == cull::kUnlimitedLevels ? "inf" : std::to_string(m.masks.levels);
    facts.lut_entries = m.masks.entries;
  }
  return facts;
}

std::string point_id(const Point& point) {
  Hasher hasher;
  hasher.add(fmt::format("ctusim sweep row {} of {}\nengine={}\ntrace={}\nfirst={}\nrays={}\nconfig={}\n", kRowVersion,
                         tool_version(), point.engine, point.trace.hash, point.first_ray, point.rays,
                         point.config_hash));
  return hasher.digest().hex();
}

pipeline::UnitConfig config_of(const Point& point) { return sim::load_config("", point.sets); }

std::vector<std::string> sets_of(const pipeline::UnitConfig& config) {
  std::vector<std::string> sets;
  for (const pipeline::Parameter& parameter : pipeline::parameters())
    if (const auto value = parameter.get(config); value != parameter.default_value)
      sets.push_back(parameter.key + "=" + sim::to_text(value));
  return sets;
}

std::string command_of(const Point& point) {
  std::string command = "ctusim run " + quoted(point.trace.name);
  if (point.engine != "cycle") command += " --engine " + point.engine;
  if (point.first_ray != 0) command += fmt::format(" --first {}", point.first_ray);
  if (point.rays != 0) command += fmt::format(" --rays {}", point.rays);
  for (const std::string& set : point.sets) command += " --set " + quoted(set);
  return command;
}

std::string to_line(const Point& point) {
  ordered_json settings = ordered_json::object();
  for (const Setting& setting : point.settings) settings[setting.key] = setting.value;
  const ordered_json json = {{"id", point.id},         {"trace", to_json(point.trace)},    {"engine", point.engine},
                             {"design", point.design}, {"config_hash", point.config_hash}, {"first", point.first_ray},
                             {"rays", point.rays},     {"settings", std::move(settings)},  {"sets", point.sets}};
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

Point point_from_line(const std::string& line, const std::string& where) {
  Point point;
  try {
    const ordered_json json = ordered_json::parse(line);
    json.at("id").get_to(point.id);
    point.trace = facts_from_json(json.at("trace"));
    json.at("engine").get_to(point.engine);
    json.at("design").get_to(point.design);
    json.at("config_hash").get_to(point.config_hash);
    json.at("first").get_to(point.first_ray);
    json.at("rays").get_to(point.rays);
    for (const auto& [key, value] : json.at("settings").items())
      point.settings.push_back({key, value.get<std::string>()});
    json.at("sets").get_to(point.sets);
  } catch (const nlohmann::json::exception& e) {
    throw Error(where, fmt::format("no point of a sweep: {}", e.what()), "run the sweep again, which plans it anew");
  }
  if (sim::config_hash(config_of(point)) != point.config_hash || point_id(point) != point.id)
    throw Error(where, "was planned by another version of ctusim",
                "use one version for all of a sweep; `ctusim sweep run` plans it anew");
  return point;
}

}  // namespace ctu::sweep
