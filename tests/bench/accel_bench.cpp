// Build time and closest-hit speed beside Embree (single ray, default flags, one thread), in one run on one scene.
// The scene is the first argument that is no benchmark flag; a generated one if there is none. After the table come
// the ratios of the best repetitions; repetitions of all benchmarks are interleaved, so that both sides meet the same
// disturbances.
//
//   ctu_bench_accel bunny.obj --benchmark_repetitions=5

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/reference/closest_hit.h"
#include "model/scene/load.h"
#include "tests/reference/embree_scene.h"
#include "tests/reference/rays.h"

namespace {

using ctu::intersect::Ray;

/// Everything timed works on this; made once.
struct Fixture {
  ctu::scene::Scene scene;
  ctu::accel::Bvh4 bvh;
  ctu::reference::FastTracer tracer;
  ctu::test::EmbreeScene embree;
  std::map<std::string, std::vector<Ray>> rays;

  explicit Fixture(const std::string& name)
      : scene(ctu::scene::load(name)), bvh(ctu::accel::build(scene.mesh, {})), tracer(bvh), embree(scene.mesh, false) {
    embree.commit();
    rays["primary"] = ctu::test::primary_rays(scene, 800, 600);
    rays["diffuse"] = ctu::test::diffuse_rays(scene, tracer, rays["primary"], 1);
    rays["random"] = ctu::test::random_rays(scene, 150000, 1);
  }
};

template <class Tracer>
void trace(benchmark::State& state, const Tracer& tracer, const std::vector<Ray>& rays) {
  std::size_t hits = 0;
  for (auto _ : state) {
    hits = 0;
    for (const Ray& ray : rays) hits += tracer.closest(ray).primitive != ctu::intersect::kNoPrimitive;
    benchmark::DoNotOptimize(hits);
  }
  state.counters["hits"] = static_cast<double>(hits);
  state.counters["rays/s"] = benchmark::Counter(
      static_cast<double>(rays.size()) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void build_ours(benchmark::State& state, const Fixture& fixture, int threads) {
  ctu::accel::BuildOptions options;
  options.threads = threads;
  for (auto _ : state) benchmark::DoNotOptimize(ctu::accel::build(fixture.scene.mesh, options));
}

void build_embree(benchmark::State& state, const Fixture& fixture) {
  std::optional<ctu::test::EmbreeScene> scene;
  for (auto _ : state) {
    state.PauseTiming();
    scene.emplace(fixture.scene.mesh, false);
    state.ResumeTiming();
    scene->commit();
  }
}

/// The usual table, and the best CPU time of every benchmark kept.
class BestTimes : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const auto [at, added] = best_.try_emplace(run.run_name.function_name, run.GetAdjustedCPUTime());
      if (!added) at->second = std::min(at->second, run.GetAdjustedCPUTime());
    }
    ConsoleReporter::ReportRuns(runs);
  }

  void print_ratios() const {
    for (const auto& [name, ours] : best_) {
      const auto peer = best_.find(name.substr(0, name.find('/')) + "/embree");
      if (name.ends_with("/ours") && peer != best_.end())
        fmt::print("{:<10} {:.2f} of Embree's speed\n", name.substr(0, name.find('/')), peer->second / ours);
    }
  }

 private:
  std::map<std::string, double> best_;
};

void register_all(const Fixture& fixture) {
  const auto add = [](const std::string& name, auto body) {
    benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMillisecond)->MinTime(0.2);
  };
  add("build/ours", [&](benchmark::State& state) { build_ours(state, fixture, 1); });
  add("build/embree", [&](benchmark::State& state) { build_embree(state, fixture); });
  for (const auto& entry : fixture.rays) {
    const std::vector<Ray>& rays = entry.second;
    add(entry.first + "/ours", [&](benchmark::State& state) { trace(state, fixture.tracer, rays); });
    add(entry.first + "/embree", [&](benchmark::State& state) { trace(state, fixture.embree, rays); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  std::string interleaved = "--benchmark_enable_random_interleaving=true";
  arguments.insert(arguments.begin() + 1, interleaved.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  try {
    const Fixture fixture(count > 1 ? arguments[1] : "gen:hair-ball");
    register_all(fixture);
    BestTimes reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    reporter.print_ratios();
  } catch (const ctu::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  return 0;
}
