// `ctusim paper raydist`: the evaluation of the ray-distribution paper with our scenes, the published values beside it.
#include <algorithm>

#include <fmt/format.h>

#include "model/base/parallel.h"
#include "sim/commands.h"
#include "sim/paper/raydist_tables.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"
#include "sim/stopwatch.h"

namespace ctu::sim {
namespace {

constexpr int kBins = 40;  // the paper's
/// One of each kind, small: four trees and more are built for each of eight lights.
const std::vector<std::string> kScenes = {"gen:hair-ball?strands=500",
                                          "gen:curly-hair?strands=200",
                                          "gen:straight-hair?strands=500",
                                          "gen:tilted-quads",
                                          "gen:foliage",
                                          "gen:tetra",
                                          "bunny",
                                          "sponza"};

SceneArgs with_picture(const PaperArgs& args) {
  SceneArgs scene = with_default_scenes(with_default_index(args.scene), kScenes);
  scene.rays = "shadow";
  if (scene.size.empty()) scene.size = args.quick ? "96x54" : "240x135";
  if (scene.spp == 0) scene.spp = args.quick ? 1 : 4;
  return scene;
}

/// The lights of a scene, side by side; each works on one thread, so that build times can be compared.
paper::RayDistributionScene measure_scene(const ListedScene& listed, const scene::Scene& scene,
                                          const paper::RayDistributionOptions& options, int threads) {
  const influence::TreeHeuristic baseline = paper::compared_heuristics()[paper::kBaseline].heuristic;
  const accel::Bvh4 global = influence::build_for(scene.mesh, {}, baseline, options.build);
  const std::vector<paper::TestLight> lights = paper::test_lights(scene);
  paper::RayDistributionScene result{listed.name, scene.mesh.primitives(), {}};
  result.lights.resize(lights.size());
  parallel_chunks(lights.size(), 1, threads, [&](std::size_t i, std::size_t) {
    result.lights[i] = paper::measure_light(scene, global, lights[i], options);
  });
  return result;
}

std::string describe(const paper::RayDistributionOptions& options) {
  return fmt::format(
      "{} bins, up to {} triangles a leaf; at most {} shadow rays from what {} x {} pixels see in {} samples, seed {}; "
      "two "
      "kinds of lights from four sides each; {} uniform affine rays.\n\n",
      options.build.bins, options.build.max_leaf_triangles, options.most_shadow_rays, options.rays.width,
      options.rays.height, options.rays.samples_per_pixel, options.rays.seed, options.affine_rays);
}

}  // namespace

int paper_raydist_command(const PaperArgs& args) {
  const SceneArgs scene_args = with_picture(args);
  const traces::RecordOptions record = record_options(scene_args);
  paper::RayDistributionOptions options;
  options.rays = record.rays;
  options.build = record.build;
  options.build.bins = kBins;
  options.build.threads = 1;
  if (args.quick) options.affine_rays = options.most_shadow_rays = 1024;

  std::vector<paper::RayDistributionScene> results;
  std::uint64_t lost = 0;
  for (const ListedScene& listed : listed_scenes(scene_args)) {
    const Stopwatch watch;
    const std::optional<scene::Scene> scene = load_listed(scene_args, listed);
    if (!scene) continue;
    results.push_back(measure_scene(listed, *scene, options, record.threads));
    for (const paper::LightResult& light : results.back().lights) lost += light.selection.lost;
    fmt::print(stderr, "{}: {:.1f} s\n", listed.name, watch.seconds());
  }
  const std::vector<paper::LookupResult> lookups = paper::measure_lookups(options.rays.seed);
  fmt::print("{}{}", describe(options), paper::raydist_report(results, lookups));
  if (lost != 0) fmt::print(stderr, "{} LOST HITS\n", lost);
  const bool agree = std::all_of(lookups.begin(), lookups.end(), [](const auto& l) { return l.agree; });
  if (!agree) fmt::print(stderr, "the octree MISSED an area\n");
  return lost == 0 && agree ? 0 : 1;
}

}  // namespace ctu::sim
