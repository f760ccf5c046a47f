// `ctusim run`, `ctusim compare`, `ctusim bench` and `ctusim config show`: everything that runs the unit.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/commands.h"
#include "sim/config_file.h"
#include "sim/ladder/percentage.h"
#include "sim/scene_args.h"
#include "sim/tailor/tailored_config.h"
#include "sim/timeline/timeline_file.h"
#include "sim/unit_runner.h"

namespace ctu::sim {
namespace {

/// Options of the timed unit that another engine would leave unheeded.
void check_engine_heeds(const RunArgs& args) {
  const auto refuse = [&](const char* option, const char* why, const char* remedy) {
    throw Error(option, fmt::format("engine {} {}", args.engine, why), remedy);
  };
  if (!args.waves_path.empty() && args.engine != "cycle" && args.engine != "both")
    refuse("--waves", "draws none", "give --engine cycle or both");
  if (!args.timeline_path.empty() && args.engine != "cycle")
    refuse("--timeline", "draws none", "give --engine cycle; it takes the same cycles as rtl");
  if (args.gives_sampling && args.engine != "sampled")
    refuse("--error, --confidence, --seed", "draws no sample", "leave them out, or give --engine sampled");
  if (args.engine == "cycle") return;
  if (args.gives_mode) refuse("--mode", "has one mode only", "leave it out, or give --engine cycle");
  if (args.gives_source && (args.engine == "estimate" || args.engine == "sampled"))
    refuse("--source", "replays recorded outcomes", "leave it out, or give --engine cycle");
  if (args.gives_source) refuse("--source", "computes all outcomes", "leave it out, or give --engine cycle");
}

struct Window {
  pipeline::Cycle first = 0, last = 0;
};

/// Of "A:B".
Window parse_window(const std::string& window) {
  Window cycles;
  const auto colon = window.find(':');
  const auto number = [&](std::string_view text, pipeline::Cycle& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && !text.empty();
  };
  if (colon == std::string::npos || !number(std::string_view(window).substr(0, colon), cycles.first) ||
      !number(std::string_view(window).substr(colon + 1), cycles.last) || cycles.first > cycles.last)
    throw Error("--window", fmt::format("\"{}\" is not a range of cycles", window),
                "write it as in --window 1000:2000");
  return cycles;
}

/// What --waves and --timeline ask, into the options.
std::optional<pipeline::Timeline> watch(const RunArgs& args, unit::RunOptions& options) {
  Window window{0, kUsualTimelineCycles - 1};
  if (!args.window.empty()) window = parse_window(args.window);
  options.waves_path = args.waves_path;
  options.waves_first = window.first;
  options.waves_last = window.last;
  if (!args.waves_path.empty() && args.window.empty())
    throw Error("--waves", "no window of cycles", "add --window A:B; a waveform of a whole run is gigabytes");
  if (args.timeline_path.empty()) return std::nullopt;
  check_timeline_name(args.timeline_path);
  if (window.last - window.first >= kMostTimelineCycles)
    throw Error("--window", fmt::format("a timeline of more than {} cycles", kMostTimelineCycles),
                "choose a shorter window");
  check_writable(args.timeline_path);
  return pipeline::Timeline(window.first, window.last);
}

void print_compare_header(bool markdown) {
  if (markdown)
    fmt::print(
        "| scene | mask test | rays | intersections/ray | cycles/ray | culled | wrong hits | other visits |\n"
        "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  else
    fmt::print("{:<22}{:<13}{:>9}{:>13}{:>12}{:>10}{:>7}{:>7}{:>11}{:>10}\n", "scene", "mask test", "rays",
               "inters./ray", "cycles/ray", "culled", "wrong", "other", "cycles/s", "rays/s");
}

/// Counts are the same on every machine; speeds are left out where they would go into a page.
void print_compare_row(const RunRecord& r, bool markdown) {
  const auto& counts = r.result.counts;
  if (markdown)
    fmt::print("| {} | {} | {} | {:.3f} | {:.3f} | {:.1f} % | {} | {} |\n", r.scene, r.design, r.result.rays,
               counts.intersections_per_ray(), r.cycles_per_ray(), 100 * counts.culled_share(), r.result.wrong_hits,
               r.result.other_visits);
  else
    fmt::print("{:<22}{:<13}{:>9}{:>13.3f}{:>12.3f}{:>8.1f} %{:>7}{:>7}{:>11.3g}{:>10.3g}\n",
               r.scene.substr(r.scene.find_last_of('/') + 1), r.design, r.result.rays, counts.intersections_per_ray(),
               r.cycles_per_ray(), 100 * counts.culled_share(), r.result.wrong_hits, r.result.other_visits,
               r.cycles_per_second(), r.rays_per_second());
  std::fflush(stdout);
}

/// What a run must show: the expected hits, by the recorded way.
bool is_right(const RunRecord& record) {
  return record.result.wrong_hits == 0 && record.result.other_visits == 0 && record.twins.first_difference.empty();
}

}  // namespace

int run_command(const RunArgs& args) {
  RunPlan plan;
  require_engine(args.engine);
  check_engine_heeds(args);
  plan.engine = args.engine;
  TailoredConfig tailored = load_tailored_config(args.unit.config_path, args.unit.sets);
  plan.config = tailored.config;
  plan.parts = tailored.parts;
  plan.options = run_options(args.unit);
  plan.sampled = {ladder::parse_percentage("--error", args.error),
                  ladder::parse_percentage("--confidence", args.confidence), args.seed};
  std::optional<pipeline::Timeline> timeline = watch(args, plan.options);
  if (timeline) plan.options.timeline = &*timeline;
  if (!args.energy_path.empty()) plan.energy = energy::EnergyTable::read(args.energy_path);
  const LoadedTrace trace(args.trace);
  plan.range = trace.range(args.first_ray, args.rays);
  if (!args.json_path.empty()) check_writable(args.json_path);
  RunRecord record = run_plan(trace, plan);
  record.command = args.command;
  print_record(record);
  if (timeline) write_timeline(*timeline, args.timeline_path);
  if (!args.json_path.empty()) write_json(record, args.json_path);
  return is_right(record) ? 0 : 1;
}

int compare_command(const CompareArgs& args) {
  RunPlan plan;
  plan.config = load_config(args.unit.config_path, args.unit.sets);
  plan.options = run_options(args.unit);
  const auto designs = parse_designs(args.designs);
  if (std::find(designs.begin(), designs.end(), cull::Design::Ideal) != designs.end())
    throw Error("--designs", "ideal culling is no unit", "`ctusim culling` counts it");
  bool all_right = true;
  print_compare_header(args.markdown);
  for (const std::string& path : args.traces) {
    const LoadedTrace trace(path);
    plan.range = trace.range(0, 0);
    for (const cull::Design design : designs) {
      plan.config.mask_test.design = design;
      const RunRecord record = run_plan(trace, plan);
      print_compare_row(record, args.markdown);
      all_right &= is_right(record);
    }
  }
  return all_right ? 0 : 1;
}

int config_show_command(const UnitArgs& args, bool plain) {
  fmt::print("{}", config_to_toml(load_config(args.config_path, args.sets), !plain));
  return 0;
}

}  // namespace ctu::sim
