// Simulated cycles and rays a second of the timed unit, for each execution, source and design; CPU time.
#include <map>
#include <memory>

#include <benchmark/benchmark.h>

#include "model/unit/run.h"
#include "tests/pipeline/world.h"

namespace ctu::test {
namespace {

void run_unit(benchmark::State& state, unit::Mode mode, unit::Source source, cull::Design design) {
  static std::map<cull::Design, std::unique_ptr<World>> worlds;
  auto& world = worlds[design];
  if (!world) world = std::make_unique<World>("gen:tilted-quads?quads=3000", design, 20000);
  std::uint64_t cycles = 0, rays = 0;
  for (auto _ : state) {
    VectorFeed feed(world->blocks());
    const auto result =
        unit::run(world->config(), {world->image(), world->tester(), feed}, {.mode = mode, .source = source});
    cycles += result.cycles;
    rays += result.rays;
  }
  using benchmark::Counter;
  state.counters["cycles/s"] = Counter(static_cast<double>(cycles), Counter::kIsRate);
  state.counters["rays/s"] = Counter(static_cast<double>(rays), Counter::kIsRate);
  state.counters["cycles/ray"] = static_cast<double>(cycles) / static_cast<double>(rays);
}

using cull::Design;
using unit::Mode;
using unit::Source;
#define CTU_UNIT_BENCHMARK(mode, source, design)                                                      \
  BENCHMARK_CAPTURE(run_unit, mode##_##source##_##design, Mode::mode, Source::source, Design::design) \
      ->Unit(benchmark::kMillisecond)
CTU_UNIT_BENCHMARK(Plain, Replay, None);
CTU_UNIT_BENCHMARK(Plain, Replay, Projection);
CTU_UNIT_BENCHMARK(Plain, Exec, None);
CTU_UNIT_BENCHMARK(Plain, Exec, Projection);
CTU_UNIT_BENCHMARK(Batch, Replay, None);
CTU_UNIT_BENCHMARK(Batch, Replay, Projection);
CTU_UNIT_BENCHMARK(Cycle, Replay, None);
CTU_UNIT_BENCHMARK(Pins, Replay, None);

}  // namespace
}  // namespace ctu::test

BENCHMARK_MAIN();
