// `ctusim bench`: how fast the unit is simulated, in every mode.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/commands.h"
#include "sim/config_file.h"
#include "sim/core_speed.h"
#include "sim/loaded_trace.h"
#include "sim/unit_runner.h"

namespace ctu::sim {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Speeds of equal runs.
struct Speeds {
  std::uint64_t cycles = 0, rays = 0;
  std::vector<double> wall;         ///< seconds
  std::vector<double> core;         ///< GHz, from before and after the run
  std::vector<double> core_cycles;  ///< of the processor for one cycle of the unit
};

Speeds measure(const LoadedTrace& trace, const RunPlan& plan, int repeats) {
  Speeds speeds;
  for (int i = 0; i < repeats; ++i) {
    const double before = core_speed();
    const RunRecord record = run_plan(trace, plan);
    const double core = 0.5 * (before + core_speed());
    speeds.cycles = record.result.cycles;
    speeds.rays = record.result.rays;
    speeds.wall.push_back(record.wall_seconds);
    speeds.core.push_back(core);
    speeds.core_cycles.push_back(record.wall_seconds * core * 1e9 / double(record.result.cycles));
  }
  return speeds;
}

void print_row(const std::string& mode, const std::string& source, const Speeds& speeds) {
  const auto [fastest, slowest] = std::minmax_element(speeds.wall.begin(), speeds.wall.end());
  const double cycles = double(speeds.cycles) / 1e6;
  fmt::print("{:<8}{:<9}{:>10}{:>12.2f}{:>8.2f} to {:<5.2f}{:>10.0f}{:>10.2f}{:>14.0f}\n", mode, source, speeds.cycles,
             cycles / median(speeds.wall), cycles / *slowest, cycles / *fastest,
             double(speeds.rays) / median(speeds.wall), median(speeds.core), median(speeds.core_cycles));
  std::fflush(stdout);
}

std::vector<std::string> chosen(const std::string& name, std::vector<std::string> all) {
  return name == "all" ? all : std::vector<std::string>{name};
}

}  // namespace

int bench_command(const BenchArgs& args) {
  if (args.repeats < 1) throw Error("--repeats", "nothing to do", "give 1 or more");
  RunPlan plan;
  plan.config = load_config(args.unit.config_path, args.unit.sets);
  const LoadedTrace trace(args.trace);
  plan.range = trace.range(0, 0);
  fmt::print("{:<8}{:<9}{:>10}{:>12}{:>17}{:>10}{:>10}{:>14}   medians of {}\n", "mode", "source", "cycles",
             "Mcycles/s", "slowest, fastest", "rays/s", "core GHz", "its cycles", args.repeats);
  for (const std::string& source : chosen(args.unit.source, {"replay", "exec"}))
    for (const std::string& mode : chosen(args.unit.mode, {"plain", "batch", "cycle", "pins"})) {
      plan.options.mode = parse_mode(mode);
      plan.options.source = parse_source(source);
      print_row(mode, source, measure(trace, plan, args.repeats));
    }
  return 0;
}

}  // namespace ctu::sim
