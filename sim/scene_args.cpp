#include "sim/scene_args.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/nearest.h"
#include "model/base/parallel.h"
#include "model/cull/bit_table.h"
#include "model/cull/dedup_table.h"
#include "model/cull/ray_mask_table.h"
#include "model/scene/load.h"
#include "model/scene/rotate.h"

namespace ctu::sim {
namespace {

/// The whole text as a number, or an Error.
template <class Number>
Number parse_number(std::string_view text, const std::string& option, const std::string& remedy) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(option, fmt::format("\"{}\" is not a number", text), remedy);
  return number;
}

void parse_size(const std::string& size, traces::RayOptions& rays) {
  const std::string remedy = "write it as in --size 960x540";
  const auto x = size.find('x');
  if (x == std::string::npos) throw Error("--size", fmt::format("\"{}\" has no \"x\"", size), remedy);
  rays.width = parse_number<std::uint32_t>(std::string_view(size).substr(0, x), "--size", remedy);
  rays.height = parse_number<std::uint32_t>(std::string_view(size).substr(x + 1), "--size", remedy);
}

traces::RayOptions::Rays parse_rays(const std::string& name) {
  if (const auto kind = traces::rays_from_string(name)) return *kind;
  const std::vector<std::string> known{"primary", "diffuse", "shadow", "ao", "random"};
  throw Error("--rays", fmt::format("unknown kind \"{}\"", name),
              fmt::format("did you mean \"{}\"?", nearest_name(name, known)));
}

/// "x,y,z" over a point of the camera; empty text leaves it.
void parse_point(const char* option, const std::string& text, Vec3& point) {
  if (text.empty()) return;
  const std::string remedy = fmt::format("write it as in {} 1.5,0,-2", option);
  std::string_view rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const auto comma = axis < 2 ? rest.find(',') : rest.size();
    if (comma == std::string_view::npos) throw Error(option, fmt::format("\"{}\" is not three numbers", text), remedy);
    point[axis] = parse_number<float>(rest.substr(0, comma), option, remedy);
    if (!std::isfinite(point[axis])) throw Error(option, fmt::format("\"{}\" is not finite", text), remedy);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
}

void place_camera(const SceneArgs& args, scene::Camera& camera) {
  parse_point("--eye", args.eye, camera.eye);
  parse_point("--target", args.target, camera.target);
  parse_point("--up", args.up, camera.up);
  if (args.vertical_fov != 0) camera.vertical_fov_degrees = static_cast<float>(args.vertical_fov);
  if (camera.eye == camera.target) throw Error("--eye", "the camera looks at its own place", "move --eye or --target");
}

void parse_compression(const SceneArgs& args, cull::MaskOptions& masks) {
  if (!args.compress) {
    if (args.selection.empty()) return;
    throw Error("--selection", "there are no entries to select", "add --compress 256");
  }
  masks.entries = *args.compress;
  if (masks.entries < cull::kMinEntries || masks.entries > cull::kMaxEntries)
    throw Error(
        "--compress", fmt::format("{} entries are out of range", masks.entries),
        fmt::format("give {} to {}, or leave it out for masks as they are", cull::kMinEntries, cull::kMaxEntries));
  if (args.selection.empty()) return;
  if (const auto selection = cull::selection_from_string(args.selection)) {
    masks.selection = *selection;
    return;
  }
  throw Error(
      "--selection", fmt::format("unknown selection \"{}\"", args.selection),
      fmt::format("did you mean \"{}\"?", nearest_name(args.selection, {"top-per-node", "top-summed", "refined"})));
}

cull::MaskOptions parse_masks(const SceneArgs& args) {
  cull::MaskOptions masks;
  masks.resolution = args.resolution;
  masks.ray_resolution = args.ray_resolution == 0 ? args.resolution : args.ray_resolution;
  masks.levels = parse_levels(args.levels);
  const auto check = [](const char* option, int value, int minimum, int maximum) {
    if (value < minimum || value > maximum)
      throw Error(option, fmt::format("{} is out of range", value), fmt::format("give {} to {}", minimum, maximum));
  };
  check("--r", masks.resolution, cull::kMinResolution, cull::kMaxResolution);
  check("--r-ray", masks.ray_resolution, masks.resolution, cull::kMaxRayResolution);
  parse_compression(args, masks);
  return masks;
}

}  // namespace

std::vector<std::string> ray_kinds(const std::string& list) {
  if (list == "all") return {"primary", "diffuse", "shadow", "ao", "random"};
  return {list};
}

std::vector<cull::Design> parse_designs(const std::string& list) {
  static const std::vector<std::string> known{"none",  "ideal",      "mask-lut",   "bit-table",
                                              "dedup", "projection", "comparators"};
  std::vector<cull::Design> designs;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t comma = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, comma - begin);
    const auto design = cull::design_from_string(name);
    if (!design) {
      std::string listed;
      for (const std::string& one : known) listed += (listed.empty() ? "" : ", ") + one;
      throw Error("--designs", fmt::format("unknown design \"{}\"", name),
                  fmt::format("did you mean \"{}\"? Known: {}", nearest_name(name, known), listed));
    }
    designs.push_back(*design);
    begin = comma + 1;
  }
  return designs;
}

int parse_levels(const std::string& levels) {
  if (levels == "inf") return cull::kUnlimitedLevels;
  const int number = parse_number<int>(levels, "--l", "give 1 to 5, or inf");
  if (number < 1 || number > 5) throw Error("--l", fmt::format("{} is out of range", number), "give 1 to 5, or inf");
  return number;
}

void require_possible(cull::Design design, const cull::MaskOptions& masks) {
  if (design == cull::Design::MaskLut) cull::RayMaskTable::require_fits(masks.resolution, masks.ray_resolution);
  if (design == cull::Design::BitTable && masks.entries == 0)
    throw Error("bit-table", "the object masks are not compressed",
                "give the entries of a compression LUT, or choose dedup");
  if (design == cull::Design::BitTable) cull::BitTable::require_fits(masks.ray_resolution, masks.entries);
  if (design == cull::Design::Dedup)
    cull::DedupTable::require_fits(masks.resolution, masks.ray_resolution, masks.entries);
}

void require_box_bits(std::uint32_t bits) {
  if (bits != accel::kFullBoxBits && !accel::is_reduced(bits))
    throw Error("--box-bits", fmt::format("a coordinate cannot have {} bits", bits), "give 32, 16, 12 or 8");
}

traces::RecordOptions record_options(const SceneArgs& args) {
  traces::RecordOptions options;
  options.rays.kind = parse_rays(args.rays);
  parse_size(args.size, options.rays);
  options.rays.samples_per_pixel = args.spp;
  options.rays.bounces = args.bounces;
  options.rays.seed = args.seed;
  options.rays.count = args.count;
  options.rays.skip_primary = args.skip_primary;
  options.masks = parse_masks(args);
  options.build.max_leaf_triangles = args.leaf_triangles;
  options.build.triangle_cost = static_cast<float>(args.triangle_cost);
  if (args.threads < 0) throw Error("--threads", fmt::format("{} is below 0", args.threads), "give 0 for all cores");
  options.threads = args.threads > 0 ? args.threads : available_threads();
  options.build.threads = options.threads;
  return options;
}

scene::Scene load_scene(const SceneArgs& args, const std::string& name) {
  if (!(args.strand_thickness >= 0 && args.strand_thickness <= std::numeric_limits<float>::max()))
    throw Error("--thickness", fmt::format("{} is no width", args.strand_thickness), "give scene units, 0 or more");
  scene::LoadOptions options;
  options.strand_thickness = static_cast<float>(args.strand_thickness);
  if (args.strand_sides < 2 || args.strand_sides > scene::kMostStrandSides)
    throw Error("--sides", fmt::format("{} is out of range", args.strand_sides),
                fmt::format("give 2 for ribbons, or 3 to {} for tubes", scene::kMostStrandSides));
  options.strand_sides = args.strand_sides;
  options.without = args.without;
  scene::Scene scene = scene::load(name, options);
  place_camera(args, scene.camera);
  if (!args.turn.empty()) {
    Vec3 degrees;
    parse_point("--turn", args.turn, degrees);
    scene::rotate(scene, degrees);
  }
  for (const std::string& warning : scene.report.warnings) fmt::print(stderr, "{}: {}\n", scene.name, warning);
  return scene;
}

}  // namespace ctu::sim
