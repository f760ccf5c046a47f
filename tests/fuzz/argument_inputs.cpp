#include "tests/fuzz/argument_inputs.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "sim/config_file.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"
#include "tests/fuzz/input_folder.h"
#include "traces/ray_generator.h"

namespace ctu::fuzz {
namespace {

const InputFolder& folder() {
  static const InputFolder files;
  return files;
}

std::vector<std::string> lines_of(Input input) {
  std::vector<std::string> lines;
  std::string_view text = as_text(input);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

void check_config(const pipeline::UnitConfig& config) {
  const std::string path = folder().put("again.toml", sim::config_to_toml(config, true));
  require(sim::config_hash(sim::load_config(path, {})) == sim::config_hash(config),
          "a configuration comes back from its own text");
}

/// Sets the option of that name; numbers as the command line's parser would pass them.
void set_option(sim::SceneArgs& args, const std::string& name, const std::string& value) {
  const std::map<std::string, std::string*> texts = {
      {"size", &args.size}, {"eye", &args.eye},   {"target", &args.target}, {"up", &args.up},
      {"turn", &args.turn}, {"rays", &args.rays}, {"l", &args.levels},      {"selection", &args.selection}};
  const std::map<std::string, double*> reals = {
      {"fov", &args.vertical_fov}, {"thickness", &args.strand_thickness}, {"triangle-cost", &args.triangle_cost}};
  const std::map<std::string, int*> integers = {{"sides", &args.strand_sides},
                                                {"r", &args.resolution},
                                                {"r-ray", &args.ray_resolution},
                                                {"leaf", &args.leaf_triangles},
                                                {"threads", &args.threads}};
  const auto whole = [&] { return std::strtoull(value.c_str(), nullptr, 10); };
  if (const auto text = texts.find(name); text != texts.end()) *text->second = value;
  if (const auto real = reals.find(name); real != reals.end()) *real->second = std::strtod(value.c_str(), nullptr);
  if (const auto integer = integers.find(name); integer != integers.end()) *integer->second = static_cast<int>(whole());
  if (name == "spp") args.spp = static_cast<std::uint32_t>(whole());
  if (name == "bounces") args.bounces = static_cast<std::uint32_t>(whole());
  if (name == "count") args.count = whole();
  if (name == "seed") args.seed = whole();
  if (name == "compress") args.compress = static_cast<int>(whole());
  if (name == "without") args.without.push_back(value);
  if (name == "designs") sim::parse_designs(value);
}

/// The first rays that the options ask for.
void make_rays(const sim::SceneArgs& args) {
  constexpr std::uint64_t kPaths = 8;
  const traces::RecordOptions options = sim::record_options(args);
  const scene::Scene scene = sim::load_scene(args, "gen:straight-hair?strands=3&segments=2");
  const traces::RayGenerator generator(scene, options.rays);
  std::vector<intersect::Ray> rays;
  std::vector<intersect::Hit> hits;
  generator.generate(
      0, std::min(kPaths, generator.paths()),
      [](const intersect::Ray& ray, bool) {
        return intersect::Hit{ray.tmax, 0, 0, intersect::kNoPrimitive};
      },
      rays, hits);
  for (const intersect::Ray& ray : rays) require(intersect::is_valid(ray), "a camera's rays are valid");
  accel::build(scene.mesh, options.build);
}

}  // namespace

void read_config(Input input) {
  const std::string path = folder().put("unit.toml", input);
  accepts([&] { check_config(sim::load_config(path, {})); });
}

void read_assignments(Input input) {
  accepts([&] { check_config(sim::load_config("", lines_of(input))); });
}

void read_options(Input input) {
  accepts([&] {
    sim::SceneArgs args;
    for (const std::string& line : lines_of(input)) {
      const std::size_t space = std::min(line.find(' '), line.size());
      set_option(args, line.substr(0, space), line.substr(std::min(space + 1, line.size())));
    }
    make_rays(args);
  });
}

void read_index(Input input) {
  accepts([&] {
    sim::SceneArgs args;
    args.index = folder().put("index.txt", input);
    for (const sim::ListedScene& scene : sim::listed_scenes(args)) require(!scene.path.empty(), "a scene has a path");
  });
}

}  // namespace ctu::fuzz
