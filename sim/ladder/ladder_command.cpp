#include "sim/ladder/ladder_command.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "sim/config_file.h"
#include "sim/ladder/estimate.h"
#include "sim/ladder/ladder_rows.h"
#include "sim/ladder/percentage.h"
#include "sim/ladder/profile_store.h"
#include "sim/ladder/sampled.h"
#include "sim/loaded_trace.h"
#include "sim/paper/plot.h"
#include "sim/run_record.h"
#include "sim/stopwatch.h"
#include "sim/unit_runner.h"

namespace ctu::ladder {
namespace {

using nlohmann::ordered_json;

std::vector<double> parse_errors(const std::string& list) {
  std::vector<double> errors;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    errors.push_back(parse_percentage("--errors", list.substr(begin, end - begin)));
    begin = end + 1;
  }
  return errors;
}

/// A configuration with what its design makes of the trace.
struct Unit {
  Unit(const sim::LoadedTrace& trace, std::string name_, const pipeline::UnitConfig& config_, traces::RayRange range)
      : name(std::move(name_)),
        config(config_),
        tester(trace.tester(config.mask_test.design)),
        image(trace.unit_image(config.mask_test.design)),
        work{trace.reader(), trace.bvh(), &trace.masks(), tester, range} {}
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;

  std::string name;
  pipeline::UnitConfig config;
  cull::MaskTester tester;
  accel::Image image;
  TraceWork work;
};

class Climber {
 public:
  Climber(const LadderArgs& args, const sim::LoadedTrace& trace) : args_(args), trace_(trace) {
    options_.confidence = parse_percentage("--confidence", args.confidence);
    options_.seed = args.seed;
    for (const double error : parse_errors(args.errors)) {
      options_.error = error;
      require_possible(options_);
      errors_.push_back(error);
    }
  }

  Ladder climb(const Unit& unit) {
    Ladder ladder;
    ladder.config = unit.name;
    const bool packets = trace_.reader().manifest().packets.any();
    // From the bottom up: what the first one reads from the disk, the others find in memory.
    const sim::RunRecord cycle = run(unit, "cycle");
    right_ &= cycle.result.wrong_hits == 0;
    ladder.cycle_seconds = cycle.wall_seconds;
    if (packets) {
      ladder.rungs.push_back({.engine = "estimate", .note = "rays in packets"});
    } else {
      add_estimates(unit, ladder);
      for (const double error : errors_) add_sample(unit, error, ladder);
    }
    ladder.rungs.push_back(rung("cycle", cycle));
    add_rtl(unit, ladder);
    const bool has_rtl = ladder.rungs.back().engine == "rtl" && ladder.rungs.back().note.empty();
    ladder.reference = has_rtl ? "rtl" : "cycle";
    const double truth = has_rtl ? ladder.rungs.back().cycles : static_cast<double>(cycle.result.cycles);
    for (Rung& one : ladder.rungs) {
      one.error = one.cycles / truth - 1;
      if (one.half_width) *one.half_width *= one.cycles / truth;
    }
    if (args_.repetitions > 0 && !packets)
      for (const double error : errors_) {
        options_.error = error;
        ladder.coverages.push_back(
            measure_coverage(unit.work, unit.image, unit.config, options_, args_.repetitions, truth));
      }
    return ladder;
  }

  /// Cycles of the unit relative to those of the first one.
  void compare(const Unit& first, const Ladder& of_first, const Unit& second, Ladder& ladder) {
    for (const char* engine : {"estimate again", "cycle", "rtl"}) {
      const Rung *a = find(of_first, engine), *b = find(ladder, engine);
      if (a != nullptr && b != nullptr && a->note.empty() && b->note.empty())
        ladder.comparings.push_back({engine, b->cycles / a->cycles, std::nullopt, a->wall_seconds + b->wall_seconds});
    }
    if (trace_.reader().manifest().packets.any()) return;
    for (const double error : errors_) {
      options_.error = error;
      const sim::Stopwatch wall;
      const Comparison comparison = compare_sampled({first.work, first.image, first.config},
                                                    {second.work, second.image, second.config}, options_);
      ladder.comparings.push_back({fmt::format("sampled {:g}%, paired", 100 * error), comparison.ratio.value,
                                   comparison.ratio.half_width / comparison.ratio.value, wall.seconds()});
    }
  }
  bool right() const { return right_; }

 private:
  sim::RunRecord run(const Unit& unit, const std::string& engine) const {
    sim::RunPlan plan;
    plan.engine = engine;
    plan.config = unit.config;
    plan.range = unit.work.range;
    plan.sampled = options_;
    return sim::run_plan(trace_, plan);
  }

  static Rung rung(const std::string& engine, const sim::RunRecord& record) {
    Rung one;
    one.engine = engine;
    one.cycles = static_cast<double>(record.result.cycles);
    one.wall_seconds = record.wall_seconds;
    return one;
  }
  static const Rung* find(const Ladder& ladder, const std::string& engine) {
    for (const Rung& one : ladder.rungs)
      if (one.engine == engine) return &one;
    return nullptr;
  }

  /// With the counting of the rays' visits, and when that has been done.
  void add_estimates(const Unit& unit, Ladder& ladder) const {
    const sim::Stopwatch counting;
    const VisitProfile profile = profile_of(unit.work, unit.image, unit.config);
    const double counting_seconds = counting.seconds();
    ProfileStore().keep(profile_name(unit.work, unit.config), profile);
    Rung again = rung("estimate again", run(unit, "estimate"));
    again.share = 0;
    Rung whole = again;
    whole.engine = "estimate";
    whole.wall_seconds += counting_seconds;
    ladder.rungs.push_back(whole);
    ladder.rungs.push_back(again);
  }

  void add_sample(const Unit& unit, double error, Ladder& ladder) {
    options_.error = error;
    const sim::RunRecord record = run(unit, "sampled");
    Rung one = rung(fmt::format("sampled {:g}%", 100 * error), record);
    const sim::Approximation& a = record.approximation;
    one.half_width = 0.5 * (a.cycles_high - a.cycles_low) / one.cycles;
    one.share = static_cast<double>(a.simulated_rays) / static_cast<double>(record.result.rays);
    ladder.rungs.push_back(one);
  }

  void add_rtl(const Unit& unit, Ladder& ladder) {
    if (!args_.rtl) {
      ladder.rungs.push_back({.engine = "rtl", .note = "not asked for (--rtl)"});
      return;
    }
    try {
      const sim::RunRecord record = run(unit, "rtl");
      right_ &= record.result.wrong_hits == 0;
      ladder.rungs.push_back(rung("rtl", record));
    } catch (const Error& error) {
      fmt::print(stderr, "rtl: {}\n", error.what());
      ladder.rungs.push_back({.engine = "rtl", .note = "no build fits"});
    }
  }

  const LadderArgs& args_;
  const sim::LoadedTrace& trace_;
  SampledOptions options_;
  std::vector<double> errors_;
  bool right_ = true;
};

ordered_json to_json(const Ladder& ladder) {
  ordered_json rungs = ordered_json::array(), comparings = ordered_json::array();
  for (const Rung& one : ladder.rungs) {
    ordered_json json{{"engine", one.engine}};
    if (!one.note.empty()) {
      json["note"] = one.note;
    } else {
      json["cycles"] = one.cycles;
      json["error_percent"] = 100 * one.error;
      if (one.half_width) json["half_width_percent"] = 100 * *one.half_width;
      json["wall_seconds"] = one.wall_seconds;
      json["simulated_cycles_per_second"] = one.cycles / one.wall_seconds;
      json["simulated_share_of_rays"] = one.share;
    }
    rungs.push_back(json);
  }
  for (const Comparing& c : ladder.comparings) {
    ordered_json json{{"engine", c.engine}, {"ratio", c.ratio}};
    if (c.half_width) json["half_width_percent"] = 100 * *c.half_width;
    json["wall_seconds"] = c.wall_seconds;
    comparings.push_back(json);
  }
  ordered_json json{{"config", ladder.config}, {"errors_against", ladder.reference}, {"engines", rungs}};
  for (const Coverage& c : ladder.coverages)
    json["coverage"].push_back({{"error_percent", 100 * c.options.error},
                                {"repetitions", c.repetitions},
                                {"covered", c.covered},
                                {"whole", c.whole},
                                {"bias_percent", 100 * c.bias},
                                {"rms_percent", 100 * c.rms},
                                {"half_width_percent", 100 * c.half_width},
                                {"simulated_share_of_rays", c.share},
                                {"wall_seconds", c.wall_seconds}});
  if (!comparings.empty()) json["relative_to_first_config"] = comparings;
  return json;
}

void write_json(const LadderArgs& args, const sim::LoadedTrace& trace, std::uint64_t rays,
                const std::vector<Ladder>& ladders, const std::string& path) {
  ordered_json json{{"format", "ctusim-ladder"},
                    {"version", 1},
                    {"command", args.command},
                    {"trace", args.trace},
                    {"trace_hash", trace.reader().hash()},
                    {"scene", trace.reader().manifest().scene.name},
                    {"rays", rays},
                    {"confidence", args.confidence},
                    {"configs", ordered_json::array()}};
  for (const Ladder& ladder : ladders) json["configs"].push_back(to_json(ladder));
  std::ofstream out(path);
  out << json.dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
  if (!out.flush()) throw Error(path, "the result could not be written", "check the folder and the free space");
}

void write_folder(const LadderArgs& args, const sim::LoadedTrace& trace, std::uint64_t rays,
                  const std::vector<Ladder>& ladders) {
  const std::filesystem::path folder = args.output;
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(folder.string(), failure.message(), "choose another --out");
  write_json(args, trace, rays, ladders, (folder / "ladder.json").string());
  sim::paper::write_file(folder, "ladder.csv", to_csv(ladders));
  sim::paper::write_file(folder, "ladder.gp", plot_script(ladders, trace.reader().manifest().scene.name));
  if (sim::paper::have_gnuplot()) sim::paper::run_gnuplot(folder, "ladder.gp");
}

}  // namespace

void add_ladder(CLI::App& app, LadderArgs& args, int& exit_code) {
  auto* command = app.add_subcommand(
      "ladder", "the same rays by every engine, from closed forms to gates: cycles, error and run time of each");
  command->add_option("trace", args.trace, "trace file")->required();
  command->add_option("configs", args.configs,
                      "TOML files with units' parameters; none: the default unit. The second and later ones are also "
                      "compared with the first on paired chunks");
  command->add_option("--set", args.sets, "KEY=VALUE over each file; may be repeated")->expected(1)->take_all();
  command->add_option("--errors", args.errors, "list of errors that samples are to reach")->capture_default_str();
  command->add_option("--confidence", args.confidence, "with which their intervals hold the cycles")
      ->capture_default_str();
  command->add_option("--seed", args.seed, "of the places of their chunks")->capture_default_str();
  command->add_option("--first", args.first_ray, "first ray")->capture_default_str();
  command->add_option("--rays", args.rays, "number of rays; 0: to the end")->capture_default_str();
  command
      ->add_option("--repetitions", args.repetitions,
                   "also draw each sample so many times, with seeds from --seed on, and say how often its interval "
                   "holds the cycles")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->add_flag("--rtl", args.rtl, "also in gates, where a build fits; errors are against it then");
  command->add_option("--json", args.json_path, "write the result here");
  command->add_option("--out", args.output,
                      "folder for ladder.json, ladder.csv and the plot of error against run time");
  command->add_flag("--markdown", args.markdown, "print Markdown tables");
  command->callback([&] { exit_code = ladder_command(args); });
}

int ladder_command(const LadderArgs& args) {
  const sim::LoadedTrace trace(args.trace);
  const traces::RayRange range = trace.range(args.first_ray, args.rays);
  Climber climber(args, trace);
  if (!args.json_path.empty()) sim::check_writable(args.json_path);
  std::vector<std::string> files = args.configs;
  if (files.empty()) files.emplace_back();
  std::vector<pipeline::UnitConfig> configs;
  for (const std::string& file : files) configs.push_back(sim::load_config(file, args.sets));
  std::vector<Ladder> ladders;
  std::optional<Unit> first;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string name = files[i].empty() ? "default" : std::filesystem::path(files[i]).stem().string();
    Unit* unit = i == 0 ? &first.emplace(trace, name, configs[i], range) : nullptr;
    std::optional<Unit> other;
    if (unit == nullptr) unit = &other.emplace(trace, name, configs[i], range);
    Ladder ladder = climber.climb(*unit);
    if (i > 0) climber.compare(*first, ladders.front(), *unit, ladder);
    if (files.size() > 1) fmt::print("{}{}\n\n", args.markdown ? "**" : "", name + (args.markdown ? "**" : ""));
    fmt::print("{}\n", to_table(ladder, args.markdown));
    ladders.push_back(std::move(ladder));
  }
  if (ladders.front().reference == "cycle")
    fmt::print("Errors are against cycle, which takes the cycles of the unit in gates (docs/rtl.md).\n");
  const std::uint64_t rays = range.last - range.first;
  if (!args.json_path.empty()) write_json(args, trace, rays, ladders, args.json_path);
  if (!args.output.empty()) write_folder(args, trace, rays, ladders);
  return climber.right() ? 0 : 1;
}

}  // namespace ctu::ladder
