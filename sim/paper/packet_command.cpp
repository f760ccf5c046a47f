// `ctusim paper packets`: what every packet culling method finds in our scenes, beside what there is to find.
#include <algorithm>

#include <fmt/format.h>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/base/nearest.h"
#include "sim/commands.h"
#include "sim/paper/packet_measure.h"
#include "sim/paper/packet_tables.h"
#include "sim/ray_sample.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"
#include "sim/stopwatch.h"
#include "traces/ray_generator.h"

namespace ctu::sim {
namespace {

/// One of each kind: packets are asked about one by one in exact arithmetic.
const std::vector<std::string> kScenes = {"gen:hair-ball", "gen:curly-hair", "gen:straight-hair", "gen:tilted-quads",
                                          "gen:foliage",   "gen:tetra",      "gen:balls",         "bunny",
                                          "sponza",        "kitchen"};

reference::Forming forming_named(const std::string& name) {
  if (const auto forming = reference::forming_from_string(name)) return *forming;
  throw Error("--forming", fmt::format("unknown value \"{}\"", name),
              fmt::format("did you mean \"{}\"? give order, direction or origin",
                          nearest_name(name, {"order", "direction", "origin"})));
}

/// The rays of one kind: pixels in tiles, so that packets are square; bounces without the rays that they follow.
traces::RecordOptions rays_of(const SceneArgs& args, const std::string& kind) {
  SceneArgs one = args;
  one.rays = kind;
  traces::RecordOptions options = record_options(one);
  options.rays.tiled = true;
  options.rays.skip_primary = options.rays.kind == traces::RayOptions::Rays::Diffuse;
  return options;
}

/// Of a sample with many more rays than wanted (where few paths have any, their number is hard to guess), windows of
/// consecutive rays from all over it.
RaySample thinned(const RaySample& sample, std::size_t wanted, std::size_t window) {
  const std::size_t windows = sample.rays.size() / window, kept = wanted / window;
  if (kept == 0 || kept >= windows) return sample;
  RaySample part;
  for (std::size_t i = 0; i < kept; ++i) {
    const auto first = static_cast<std::ptrdiff_t>(i * windows / kept * window),
               last = first + static_cast<std::ptrdiff_t>(window);
    part.rays.insert(part.rays.end(), sample.rays.begin() + first, sample.rays.begin() + last);
    part.hits.insert(part.hits.end(), sample.hits.begin() + first, sample.hits.begin() + last);
  }
  return part;
}

/// A window's worth of consecutive rays from each of many parts of the picture; all rays where `rays` is 0.
RaySample sample_of(const scene::Scene& scene, const accel::Bvh4& bvh, const traces::RecordOptions& options,
                    std::uint64_t rays, int window) {
  const cull::MaskTester none(cull::Design::None, {});
  const reference::Traversal alone(bvh, nullptr, none);
  const traces::RayGenerator generator(scene, options.rays);
  if (rays == 0) return sample_rays(generator, alone, {}, options.threads);
  const auto runs = static_cast<int>(std::clamp<std::uint64_t>(rays / static_cast<std::uint64_t>(window), 1, 1024));
  const RaySample sample = sample_rays(generator, alone, {.rays = rays, .runs = runs}, options.threads);
  return thinned(sample, rays, static_cast<std::size_t>(window));
}

void add_to_sweep(const scene::Scene& scene, const accel::Bvh4& bvh, const RaySample& sample,
                  paper::PacketMeasureOptions options, paper::PacketSweep& sweep) {
  if (sample.rays.empty()) return;
  ++sweep.scenes;
  for (std::size_t f = 0; f < paper::kSweepForming.size(); ++f)
    for (std::size_t s = 0; s < paper::kSweepSizes.size(); ++s) {
      options.forming.forming = paper::kSweepForming[f];
      options.forming.size = paper::kSweepSizes[s];
      options.forming.window = std::max(options.forming.window, options.forming.size);
      const paper::PacketWork work =
          measure_packet_work(scene, bvh, sample, cull::packet::Method::AxisInterval, options);
      const paper::PacketShares shares = paper::shares_of(work.counts);
      sweep.cells[f][s].ray_tests += 100 * shares.ray_tests;
      sweep.cells[f][s].all_tests += 100 * (shares.ray_tests + shares.packet_tests);
    }
}

}  // namespace

int paper_packets_command(const PaperPacketsArgs& args) {
  const SceneArgs scene_args = with_default_scenes(with_default_index(args.scene), kScenes);
  paper::PacketMeasureOptions measure;
  measure.forming = {.size = args.size, .window = args.window, .forming = forming_named(args.forming)};
  check(measure.forming);
  measure.least_rays = args.least_rays;
  std::vector<paper::PacketSweep> sweeps;
  for (const std::string& kind : ray_kinds(scene_args.rays)) sweeps.push_back({kind, 0, {}});
  for (const paper::PacketSweep& sweep : sweeps) measure.threads = rays_of(scene_args, sweep.rays).threads;

  std::vector<paper::PacketRow> rows;
  std::uint64_t wrong = 0;
  for (const ListedScene& listed : listed_scenes(scene_args)) {
    const Stopwatch watch;
    const std::optional<scene::Scene> scene = load_listed(scene_args, listed);
    if (!scene) continue;
    const accel::Bvh4 bvh = accel::build(scene->mesh, rays_of(scene_args, sweeps.front().rays).build);
    for (paper::PacketSweep& sweep : sweeps) {
      const RaySample sample = sample_of(*scene, bvh, rays_of(scene_args, sweep.rays), args.sample, args.window);
      rows.push_back({listed.name, sweep.rays, measure_packets(*scene, bvh, sample, measure)});
      add_to_sweep(*scene, bvh, sample, measure, sweep);
      wrong += rows.back().result.wrong();
    }
    fmt::print(stderr, "{}: {:.1f} s\n", listed.name, watch.seconds());
  }
  fmt::print(
      "Packets of up to {} rays, formed by {} in windows of {}; fewer than {} rays at one place go on alone; about {} "
      "rays of each kind, seed {}.\n\n",
      measure.forming.size, to_string(measure.forming.forming), measure.forming.window, measure.least_rays, args.sample,
      scene_args.seed);
  fmt::print("{}", paper::packet_report(rows, sweeps));
  return wrong == 0 ? 0 : 1;
}

}  // namespace ctu::sim
