// Time to build object masks, by R, L and threads; and to refit tree and masks after some of the vertices have
// moved. The scene is the first argument that is no benchmark flag; a generated one if there is none.
//
//   ctu_bench_masks bunny.obj --benchmark_filter=build/

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "model/accel/build.h"
#include "model/accel/refit.h"
#include "model/base/error.h"
#include "model/base/parallel.h"
#include "model/cull/object_masks.h"
#include "model/cull/refit_masks.h"
#include "model/scene/load.h"

namespace {

using ctu::cull::MaskOptions;

struct Fixture {
  ctu::scene::Mesh mesh;
  ctu::accel::Bvh4 bvh;

  explicit Fixture(const std::string& name) : mesh(ctu::scene::load(name).mesh), bvh(ctu::accel::build(mesh, {})) {}
};

std::string levels_name(int levels) { return levels == ctu::cull::kUnlimitedLevels ? "inf" : std::to_string(levels); }

/// A part of the vertices, moved a thousandth of the scene: those nearest to one of them, as where something dents a
/// surface.
ctu::scene::Mesh dented(const Fixture& fixture, double part) {
  ctu::scene::Mesh mesh = fixture.mesh;
  const ctu::Vec3 lower = fixture.bvh.lower, upper = fixture.bvh.upper,
                  centre = mesh.vertices[mesh.vertices.size() / 3];
  std::vector<std::pair<double, std::size_t>> nearest;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    double squared = 0;
    for (int a = 0; a < 3; ++a) {
      const double d = static_cast<double>(mesh.vertices[i][a]) - centre[a];
      squared += d * d;
    }
    nearest.emplace_back(squared, i);
  }
  const auto count = static_cast<std::ptrdiff_t>(part * static_cast<double>(nearest.size()) + 0.5);
  std::partial_sort(nearest.begin(), nearest.begin() + count, nearest.end());
  for (auto i = nearest.begin(); i != nearest.begin() + count; ++i)
    for (int a = 0; a < 3; ++a) mesh.vertices[i->second][a] += 1e-3f * (upper[a] - lower[a]);
  return mesh;
}

void build_masks(benchmark::State& state, const Fixture& fixture, const MaskOptions& options, int threads) {
  for (auto _ : state) benchmark::DoNotOptimize(ctu::cull::build_object_masks(fixture.bvh, options, threads));
  state.counters["triangles/s"] = benchmark::Counter(
      static_cast<double>(fixture.mesh.triangles.size() * state.iterations()), benchmark::Counter::kIsRate);
}

/// There and back: every iteration moves the vertices, so that each has the same to do.
template <class AfterRefit>
void refit(benchmark::State& state, const Fixture& fixture, double part, int threads, AfterRefit&& after_refit) {
  const ctu::scene::Mesh there = dented(fixture, part);
  ctu::accel::Bvh4 bvh = fixture.bvh;
  bool away = false;
  for (auto _ : state) {
    away = !away;
    after_refit(bvh, ctu::accel::refit(bvh, away ? there : fixture.mesh, threads));
  }
}

void refit_boxes(benchmark::State& state, const Fixture& fixture, double part, int threads) {
  refit(state, fixture, part, threads, [](const auto& bvh, const auto& changes) {
    benchmark::DoNotOptimize(&bvh), benchmark::DoNotOptimize(&changes);
  });
}

void refit_boxes_and_masks(benchmark::State& state, const Fixture& fixture, double part, const MaskOptions& options,
                           int threads) {
  ctu::cull::ObjectMasks masks = ctu::cull::build_object_masks(fixture.bvh, options, threads);
  refit(state, fixture, part, threads, [&](const auto& bvh, const auto& changes) {
    ctu::cull::refit_object_masks(masks, bvh, changes, options, threads);
  });
}

template <class Body>
void add(const std::string& name, Body body) {
  benchmark::RegisterBenchmark(name.c_str(), body)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime();
}

void register_builds(const Fixture& fixture, int threads) {
  for (const int r : {4, 6})
    for (const int levels : {1, 2, 3, 4, 5, ctu::cull::kUnlimitedLevels})
      add(fmt::format("build/R={}/L={}/threads={}", r, levels_name(levels), threads),
          [&fixture, r, levels, threads](benchmark::State& state) {
            build_masks(state, fixture, {.resolution = r, .ray_resolution = r, .levels = levels}, threads);
          });
}

void register_refits(const Fixture& fixture, int threads) {
  for (const double part : {0.0, 0.001, 0.01, 1.0}) {
    const std::string moved = fmt::format("moved={}%/threads={}", 100 * part, threads);
    add("refit/boxes/" + moved,
        [&fixture, part, threads](benchmark::State& state) { refit_boxes(state, fixture, part, threads); });
    for (const int r : {4, 6})
      for (const int levels : {1, 3, ctu::cull::kUnlimitedLevels})
        add(fmt::format("refit/boxes+masks/R={}/L={}/{}", r, levels_name(levels), moved),
            [&fixture, part, r, levels, threads](benchmark::State& state) {
              refit_boxes_and_masks(state, fixture, part, {.resolution = r, .ray_resolution = r, .levels = levels},
                                    threads);
            });
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  try {
    const Fixture fixture(argc > 1 ? argv[1] : "gen:hair-ball");
    fmt::print("{} triangles, {} nodes\n", fixture.mesh.triangles.size(), fixture.bvh.nodes.size());
    std::vector<int> threads{1};
    for (int t = 2; t <= ctu::available_threads(); t *= 2) threads.push_back(t);
    for (const int t : threads) {
      register_builds(fixture, t);
      register_refits(fixture, t);
    }
    benchmark::RunSpecifiedBenchmarks();
  } catch (const ctu::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  return 0;
}
