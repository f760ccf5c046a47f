#include "sim/run_record.h"

#include <algorithm>

#include <fmt/format.h>

#include "sim/energy/cost_print.h"

namespace ctu::sim {
namespace {

double ratio(double numerator, double denominator) { return denominator == 0 ? 0 : numerator / denominator; }
double percent(std::uint64_t part, std::uint64_t whole) {
  return 100 * ratio(static_cast<double>(part), static_cast<double>(whole));
}

template <class Row>
void print_twins(const TwinComparison& twins, const Row& row) {
  row("compared", fmt::format("{} handshakes, {} signals", twins.handshakes, twins.signals));
  row("differences", twins.first_difference.empty() ? "0" : "1, and stopped there");
  if (twins.first_difference.empty()) return;
  row("first difference", twins.first_difference);
  row("waveforms", fmt::format("{0}.model.vcd, {0}.rtl.vcd", twins.waves));
}

template <class Row>
void print_approximation(const RunRecord& r, const Row& row) {
  const Approximation& a = r.approximation;
  if (r.engine == "estimate") row("limited by", a.limit);
  if (r.engine != "sampled") return;
  row("cycles lie in",
      fmt::format("{:.0f} to {:.0f}, +-{:.2f} %, with a probability of {:g} %", a.cycles_low, a.cycles_high,
                  100 * ratio(a.cycles_high - a.cycles_low, 2.0 * double(r.result.cycles)), a.confidence));
  row("sample", fmt::format("{} chunks, {} rays simulated ({:.2f} %), {} cycles", a.chunks, a.simulated_rays,
                            percent(a.simulated_rays, r.result.rays), a.simulated_cycles));
}

template <class Row>
void print_saved_on_the_way(const pipeline::UnitResult& result, const Row& row) {
  if (const auto saved = result.counter("packets.node_tests_saved"))
    row("saved by packets", fmt::format("{} box tests of single rays, by the recording", *saved));
  const auto own = result.counter("trees.own_tests"), global = result.counter("trees.global_tests");
  if (!own || !global) return;
  row("saved by local trees",
      fmt::format("{} box and primitive tests of {} without culling, by the recording",
                  static_cast<std::int64_t>(*global) - static_cast<std::int64_t>(*own), *global));
}

void print_summary(const RunRecord& r) {
  const auto& counts = r.result.counts;
  const auto row = [](std::string_view name, const std::string& value) { fmt::print("{:<24}{}\n", name, value); };
  row("trace", fmt::format("{} ({}), hash {}", r.trace_path, r.scene, r.trace_hash));
  row("engine", r.engine == "cycle" ? fmt::format("cycle, {} mode, {}", r.mode, r.source) : r.engine);
  row("mask test", r.design);
  row("config", r.config_hash);
  row("rays", std::to_string(r.result.rays));
  if (r.runs_rays()) row("wrong hits", std::to_string(r.result.wrong_hits));
  if (r.source == "exec") row("other visits", std::to_string(r.result.other_visits) + " than recorded");
  row("intersections per ray",
      fmt::format("{:.3f} ({:.3f} box tests of 4, {:.3f} triangle tests)", counts.intersections_per_ray(),
                  ratio(double(counts.node_visits), double(counts.rays)),
                  ratio(double(counts.triangle_tests), double(counts.rays))));
  row("culled share", fmt::format("{:.2f} % of {} box hits", 100 * counts.culled_share(), counts.box_hits));
  if (counts.boxed_out != 0)
    row("saved by ray boxes",
        fmt::format("{} primitive tests, {:.2f} % of those in the leaves visited", counts.boxed_out,
                    percent(counts.boxed_out, counts.boxed_out + counts.triangle_tests)));
  print_saved_on_the_way(r.result, row);
  if (r.engine != "rtl") row("passed as uncertain", fmt::format("{} box hits", counts.uncertain));
  if (r.timed()) {
    row("cycles", std::to_string(r.result.cycles));
    row("cycles per ray", fmt::format("{:.3f}", r.cycles_per_ray()));
  }
  if (r.timed() && r.engine != "rtl")
    row("latency of a ray",
        fmt::format("{:.1f} cycles", ratio(double(r.result.ray_latency_sum), double(r.result.rays))));
  if (r.engine == "both") print_twins(r.twins, row);
  if (!r.runs_rays()) print_approximation(r, row);
  row("simulation speed",
      fmt::format("{:.3g} rays/s{} in {:.3f} s", r.rays_per_second(),
                  r.timed() ? fmt::format(", {:.3g} cycles/s", r.cycles_per_second()) : "", r.wall_seconds));
}

void print_stages(const pipeline::UnitResult& result) {
  fmt::print("\n{:<18}{:>9}{:>9}{:>9}   stalled by\n", "stage", "busy %", "stall %", "idle %");
  for (const auto& stage : result.stages) {
    std::uint64_t stalled = 0;
    std::string causes;
    for (const auto& cause : stage.stalled) {
      stalled += cause.cycles;
      if (cause.cycles != 0)
        causes +=
            fmt::format("{}{} {:.1f} %", causes.empty() ? "" : ", ", cause.name, percent(cause.cycles, result.cycles));
    }
    fmt::print("{:<18}{:>9.1f}{:>9.1f}{:>9.1f}   {}\n", stage.stage, percent(stage.busy, result.cycles),
               percent(stalled, result.cycles), percent(stage.idle, result.cycles), causes);
  }
}

void print_ray_cycles(const pipeline::UnitResult& result) {
  fmt::print("\n{:<26}{:>14}{:>9}   (where a ray's time goes)\n", "cause", "cycles/ray", "share %");
  for (const auto& cause : result.ray_cycles) {
    if (cause.cycles == 0) continue;
    fmt::print("{:<26}{:>14.2f}{:>9.1f}   {}\n", cause.name, ratio(double(cause.cycles), double(result.rays)),
               percent(cause.cycles, result.ray_latency_sum), cause.description);
  }
}

void print_counters(const pipeline::UnitResult& result) {
  std::size_t width = 0;
  for (const auto& counter : result.counters) width = std::max(width, counter.name.size());
  fmt::print("\n{:<{}}  {:>14}\n", "counter", width, "value");
  for (const auto& counter : result.counters)
    fmt::print("{:<{}}  {:>14} {:<9} {}\n", counter.name, width, counter.value, counter.unit, counter.description);
}

void print_wrong_hits(const pipeline::UnitResult& result) {
  for (const auto& wrong : result.first_wrong)
    fmt::print("WRONG ray {}: expected t={:a} u={:a} v={:a} primitive={}, returned t={:a} u={:a} v={:a} primitive={}\n",
               wrong.ray, wrong.expected.t, wrong.expected.u, wrong.expected.v, wrong.expected.primitive,
               wrong.returned.t, wrong.returned.u, wrong.returned.v, wrong.returned.primitive);
}

}  // namespace

double RunRecord::cycles_per_ray() const { return ratio(double(result.cycles), double(result.rays)); }
double RunRecord::cycles_per_second() const { return ratio(double(result.cycles), wall_seconds); }
double RunRecord::rays_per_second() const { return ratio(double(result.rays), wall_seconds); }

void print_record(const RunRecord& record) {
  print_summary(record);
  if (record.timed()) print_stages(record.result);
  if (record.engine != "rtl" && record.timed()) {
    print_ray_cycles(record.result);
    print_counters(record.result);
    if (!record.result.left_out.empty()) fmt::print("\nleft out, because this trace does not need it:\n");
    for (const std::string& item : record.result.left_out) fmt::print("  {}\n", item);
  }
  energy::print_cost(record.cost);
  print_wrong_hits(record.result);
}

}  // namespace ctu::sim
