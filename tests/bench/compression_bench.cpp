// Table 3 of the subspace culling paper: finding every child's mask in a compression LUT of 256 entries, by brute force
// and by Algorithm 3, at R = 4 and R = 6. The scene is the first argument that is no benchmark flag; a generated one
// if there is none.
//
//   ctu_bench_compression bunny.ply --benchmark_repetitions=5

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "model/cull/compress.h"
#include "model/cull/requirement_luts.h"
#include "model/scene/load.h"

namespace {

using ctu::cull::CompressionLut;
using ctu::cull::RequirementLuts;
using ctu::cull::Selection;

constexpr int kEntries = 256;

/// The masks to look for and the paper's table to find them in.
struct Fixture {
  int resolution;
  std::vector<const std::uint64_t*> children;
  ctu::cull::ObjectMasks masks;
  CompressionLut lut;

  Fixture(const ctu::accel::Bvh4& bvh, int r)
      : resolution(r),
        masks(ctu::cull::build_object_masks(bvh, {.resolution = r}, 1)),
        lut(ctu::cull::compress(bvh, masks, {.resolution = r, .entries = kEntries, .selection = Selection::TopPerNode},
                                1)
                .lut) {
    for (std::uint32_t node = 0; node < bvh.nodes.size(); ++node)
      for (int lane = 0; lane < ctu::intersect::kLanes; ++lane)
        if (bvh.nodes[node].child[lane] != ctu::accel::kEmptyChild) children.push_back(masks.mask(node, lane));
  }
};

template <class Find>
void find_all(benchmark::State& state, const Fixture& fixture, Find&& find) {
  for (auto _ : state)
    for (const std::uint64_t* mask : fixture.children) benchmark::DoNotOptimize(find(mask));
  state.counters["masks"] = static_cast<double>(fixture.children.size());
  state.counters["masks/s"] =
      benchmark::Counter(static_cast<double>(fixture.children.size()) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

void register_searches(const Fixture& fixture) {
  const auto add = [&](const std::string& name, auto body) {
    benchmark::RegisterBenchmark(fmt::format("R={}/{}", fixture.resolution, name).c_str(), body)
        ->Unit(benchmark::kMillisecond);
  };
  add("brute force", [&](benchmark::State& state) {
    find_all(state, fixture, [&](const std::uint64_t* mask) { return fixture.lut.tightest(mask); });
  });
  for (const int chunk_bits : {4, 8, 12})
    add(fmt::format("Algorithm 3, b={}", chunk_bits), [&fixture, chunk_bits](benchmark::State& state) {
      const RequirementLuts search(fixture.lut, chunk_bits);
      find_all(state, fixture, [&](const std::uint64_t* mask) { return search.find(mask); });
      state.counters["KiB"] = static_cast<double>(search.bytes()) / 1024;
    });
  add("building the requirement LUTs, b=8", [&](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(RequirementLuts(fixture.lut, 8).bytes());
  });
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  try {
    const ctu::scene::Scene scene = ctu::scene::load(argc > 1 ? argv[1] : "gen:hair-ball");
    const ctu::accel::Bvh4 bvh = ctu::accel::build(scene.mesh, {});
    const Fixture four(bvh, 4), six(bvh, 6);
    register_searches(four);
    register_searches(six);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const ctu::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  return 0;
}
