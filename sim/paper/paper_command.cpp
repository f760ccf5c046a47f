// `ctusim paper subspace`: the evaluation of the subspace culling paper with our scenes, the published values beside
// it.
#include <filesystem>

#include <fmt/format.h>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "sim/commands.h"
#include "sim/paper/plot.h"
#include "sim/paper/subspace_measure.h"
#include "sim/paper/subspace_plots.h"
#include "sim/paper/subspace_tables.h"
#include "sim/progress.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"
#include "sim/stopwatch.h"

namespace ctu::sim {
namespace {

constexpr const char* kReport = "subspace.md";

/// The paper's 960 x 540 and 16 samples, or a small setting, and the unpacked scenes, unless the user says otherwise.
SceneArgs with_picture(const PaperArgs& args) {
  SceneArgs scene = with_default_index(args.scene);
  scene.rays = "diffuse";
  if (scene.size.empty()) scene.size = args.quick ? "160x90" : "960x540";
  if (scene.spp == 0) scene.spp = args.quick ? 1 : 16;
  return scene;
}

paper::MeasureOptions measure_options(const PaperArgs& args, const traces::RecordOptions& options) {
  paper::MeasureOptions measure;
  measure.survey.rays = options.rays;
  measure.survey.threads = options.threads;
  measure.survey.timed_repeats = 3;
  measure.survey.timed_every = args.quick ? 1 : 16;
  return measure;
}

std::string describe(const traces::RecordOptions& options, const paper::MeasureOptions& measure) {
  const auto& rays = options.rays;
  const int every = measure.survey.timed_every;
  return fmt::format(
      "{} x {} pixels, {} sample{} per pixel, up to {} diffuse bounces, seed {}; unlimited L but where L is said, up "
      "to "
      "{} triangles a leaf, {} threads. Times are processor times; those of Table 2 are medians of {} interleaved "
      "repeats over {} rays.\n\n",
      rays.width, rays.height, rays.samples_per_pixel, rays.samples_per_pixel == 1 ? "" : "s", rays.bounces, rays.seed,
      options.build.max_leaf_triangles, options.threads, measure.survey.timed_repeats,
      every == 1 ? std::string("all") : fmt::format("one in {}", every));
}

paper::SceneResult measure_scene(const ListedScene& listed, const scene::Scene& scene,
                                 const std::vector<const paper::RayTables*>& tables,
                                 const traces::RecordOptions& options, const paper::MeasureOptions& measure) {
  const accel::Bvh4 bvh = accel::build(scene.mesh, options.build);
  paper::SceneResult result;
  result.name = listed.name;
  result.triangles = scene.mesh.triangles.size();
  result.nodes = bvh.nodes.size();
  for (std::size_t r = 0; r < tables.size(); ++r) {
    Progress bar(fmt::format("{}, R = {}", listed.name, tables[r]->resolution()), 0, "paths");
    result.at[r] = measure_subspace(scene, bvh, *tables[r], measure, [&](std::uint64_t done) { bar.update(done); });
  }
  return result;
}

/// Whether every hit was kept and every search agreed; says on stderr what did not.
bool check(const paper::SceneResult& result) {
  bool sound = true;
  for (const paper::ResolutionResult& at : result.at) {
    if (at.lost_hits != 0) fmt::print(stderr, "{}, R = {}: {} LOST HITS\n", result.name, at.resolution, at.lost_hits);
    if (at.search.differences != 0)
      fmt::print(stderr, "{}, R = {}: the requirement LUTs found another entry for {} masks\n", result.name,
                 at.resolution, at.search.differences);
    sound = sound && at.lost_hits == 0 && at.search.differences == 0;
  }
  return sound;
}

}  // namespace

int paper_subspace_command(const PaperArgs& args) {
  const SceneArgs scene_args = with_picture(args);
  const traces::RecordOptions options = record_options(scene_args);
  const paper::MeasureOptions measure = measure_options(args, options);
  const std::vector<ListedScene> scenes = listed_scenes(scene_args);
  const std::filesystem::path folder(args.output);
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(args.output, failure.message(), "choose another --out");
  paper::write_file(folder, kReport, "");

  std::vector<paper::RayTables> tables;
  for (const int resolution : paper::kResolutions) tables.emplace_back(resolution);
  std::vector<const paper::RayTables*> table_list;
  for (const paper::RayTables& table : tables) table_list.push_back(&table);

  std::vector<paper::SceneResult> results;
  std::string report;
  bool sound = true;
  for (const ListedScene& listed : scenes) {
    const Stopwatch watch;
    const std::optional<scene::Scene> scene = load_listed(scene_args, listed);
    if (!scene) continue;
    results.push_back(measure_scene(listed, *scene, table_list, options, measure));
    sound = check(results.back()) && sound;
    // A long run leaves what it has measured so far.
    report = describe(options, measure) + paper::report(results, table_list);
    paper::write_file(folder, kReport, report);
    paper::write_plot_files(results, folder);
    fmt::print(stderr, "{}: {:.1f} s\n", listed.name, watch.seconds());
  }
  fmt::print("{}", report);
  if (!results.empty()) paper::draw_plots(folder);
  return sound ? 0 : 1;
}

}  // namespace ctu::sim
