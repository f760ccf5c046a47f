// `ctusim paper raybox`: the evaluation of "Ray-Box Culling for Tree Structures" on its scenes, as far as they are at
// hand, the published values beside ours.
#include <optional>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/commands.h"
#include "sim/paper/raybox_tables.h"
#include "sim/progress.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"
#include "sim/stopwatch.h"

namespace ctu::sim {
namespace {

/// What Table 1 says of a scene, and which of ours stands for it.
struct PaperScene {
  const char* name;
  std::size_t paper;  ///< its place in published_raybox()
  std::uint32_t width, height, samples;
  int bounces;
  const char* remark;
};

// Lights are those of the scene's own file where it has them; the paper names their number and kind only.
constexpr PaperScene kScenes[] = {
    {"gen:balls", 0, 900, 900, 2, 0, "the same; shadow rays to SPD's three lights, no reflected rays"},
    {"killeroo", 1, 684, 513, 4, 0, "two animals, a floor, a wall and the light's sphere; the paper counts one animal"},
    {"buddha", 2, 256, 600, 4, 0, "a reduction to 29,890 triangles; camera and light are ours"},
    {"sponza", 3, 750, 350, 1, 0, "the same model; camera and light are ours"},
    {"sponza", 4, 750, 350, 8, 3, "the same model; camera and light are ours"},
};

std::vector<paper::RayboxLight> lights_of(const std::string& name) {
  if (name == "gen:balls") return {{{4, 3, 2}, 0}, {{1, -4, 4}, 0}, {{-3, 1, 5}, 0}};
  if (name == "killeroo") return {{{150, 120, 20}, 3}};
  return {};
}

paper::RayboxSetting setting_of(const PaperScene& scene, const PaperArgs& args) {
  paper::RayboxSetting setting;
  const std::uint32_t smaller = args.quick ? 5 : 1;
  setting.width = scene.width / smaller;
  setting.height = scene.height / smaller;
  setting.samples = args.scene.spp != 0 ? args.scene.spp : args.quick ? 1 : scene.samples;
  setting.lights = lights_of(scene.name);
  setting.bounces = scene.bounces;
  setting.seed = args.scene.seed;
  return setting;
}

/// Those of the paper's scenes that are wanted and at hand, in the paper's order.
std::optional<ListedScene> listed(const std::vector<ListedScene>& all, const std::string& name) {
  for (const ListedScene& one : all)
    if (one.name == name) return one;
  return std::nullopt;
}

std::string describe(const PaperArgs& args, int threads) {
  return fmt::format(
      "The paper's pictures{}, seed {}; kd-trees as pbrt builds them (costs 1 and 80, empty bonus 0.5). N_T counts "
      "inner "
      "nodes and leaves, per ray as all else. Times are processor times of {} thread{}, of trees and rays alone; the "
      "paper's are of pbrt with shading.\n\n",
      args.quick ? " at a fifth of width and height and one sample a pixel" : "", args.scene.seed, threads,
      threads == 1 ? "" : "s");
}

}  // namespace

int paper_raybox_command(const PaperArgs& args) {
  SceneArgs scene_args = with_default_index(args.scene);
  if (scene_args.scenes.empty() && scene_args.index.empty()) scene_args.scenes = {"gen:balls"};
  const int threads = record_options(scene_args).threads;
  std::vector<ListedScene> all = listed_scenes(scene_args);
  if (args.scene.scenes.empty() && !listed(all, "gen:balls")) all.push_back({"gen:balls", "gen:balls", false});

  std::vector<paper::RayboxRow> rows;
  bool sound = true;
  for (const PaperScene& wanted : kScenes) {
    const std::optional<ListedScene> one = listed(all, wanted.name);
    const std::optional<scene::Scene> scene = one ? load_listed(scene_args, *one) : std::nullopt;
    if (!scene) continue;
    const Stopwatch watch;
    Progress bar(wanted.name, 0, "paths");
    paper::RayboxRow row{
        paper::measure_raybox(*scene, setting_of(wanted, args), threads, [&](std::uint64_t done) { bar.update(done); }),
        &paper::published_raybox()[wanted.paper], wanted.remark};
    row.ours.name = wanted.bounces == 0 ? one->name : one->name + ", paths";
    if (row.ours.changed.lost != 0) fmt::print(stderr, "{}: {} LOST HITS\n", row.ours.name, row.ours.changed.lost);
    sound = sound && row.ours.changed.lost == 0;
    fmt::print(stderr, "{}: {:.1f} s\n", row.ours.name, watch.seconds());
    rows.push_back(std::move(row));
  }
  if (rows.empty())
    throw Error("paper raybox", "none of the scenes is one of the paper's",
                "name gen:balls, killeroo, buddha or sponza, the last three from an index");
  fmt::print("{}{}", describe(args, threads), paper::raybox_report(rows));
  return sound ? 0 : 1;
}

}  // namespace ctu::sim
