// ctu_grid: both twins in lock step over configurations and traces; one line for each, and 1 at the first difference.
//
//   ctu_grid FOLDER [--quick] [--rays N] [--only TEXT] [--baseline FILE [--update]]
//
// FOLDER holds the builds of the RTL unit (build/release/rtl). --quick: the share that the test suite runs. --only:
// configurations whose line holds the text. --baseline: a run whose cycles are not those of the file counts as a
// difference, be it faster or slower; --update writes what the runs took into it.
#include <cstring>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/pipeline/engine.h"
#include "sim/config_file.h"
#include "sim/cosim/lock_step.h"
#include "sim/cosim/rtl_builds.h"
#include "tests/cosim/baseline.h"
#include "tests/cosim/grid_configs.h"
#include "tests/cosim/grid_traces.h"
#include "tests/oracle/seed.h"

namespace ctu::cosim {
namespace {

struct Arguments {
  std::string folder, only, baseline;
  bool quick = false, update = false;
  int rays = 240;
};

struct Totals {
  std::uint64_t runs = 0, rays = 0, cycles = 0, handshakes = 0, compared = 0, differences = 0;
};

/// Empty where rays travel alone in one tree.
std::string ways_of(const GridConfig& config) {
  std::string text;
  if (config.packets.any())
    text += fmt::format(" packets {} entries {}", config.packets.size, config.packets.most_entries);
  if (config.trees > 1) text += fmt::format(" trees {}", config.trees);
  return text;
}

/// Worlds by trace and masks: many configurations share them.
class Worlds {
 public:
  test::World& get(const std::string& trace, const RtlParameters& build, int rays, const GridConfig& config) {
    const bool from_outside = build.rows == cull::TableRows::Reachable;  // only these have rows
    const int leaf_bytes = build.primitive_boxes ? build.max_leaf_bytes : 0;
    auto& world = worlds_[fmt::format("{} {} {} {} {} {} {} {} {} {}", trace, static_cast<int>(build.design),
                                      build.resolution, build.ray_resolution, build.entries, build.box_bits,
                                      from_outside, leaf_bytes, build.spheres, ways_of(config))];
    if (world) return *world;
    world = make_grid_world(trace, build, rays, config.packets, config.trees);
    if (from_outside)
      world = std::make_unique<test::World>(world->tree(), build.design, rays_from_outside(*world), mask_options(build),
                                            build.box_bits, build.primitive_boxes);
    return *world;
  }

 private:
  std::map<std::string, std::unique_ptr<test::World>> worlds_;
};

/// The twins in lock step over one world.
LockStepResult run(const GridConfig& config, const std::string& trace, RtlUnit& unit, test::World& world,
                   Totals& totals) {
  test::VectorFeed model_feed(world.blocks(), world.packets()), rtl_feed(world.blocks(), world.packets());
  const pipeline::UnitConfig unit_configuration = unit_config(unit.parameters(), config.settings);
  const pipeline::Work model_work{world.image(), world.tester(), model_feed},
      rtl_work{world.image(), world.tester(), rtl_feed};
  const std::string reason = misfit(unit.parameters(), unit_configuration, rtl_work);
  if (!reason.empty()) throw Error(config.build + " " + config.settings, reason, "change the grid or the build");
  LockStepOptions options;
  options.stall_seed = config.stall_seed;
  const LockStepResult result = run_lock_step(unit, unit_configuration, model_work, rtl_work, options);
  const bool agree = !result.difference && result.rtl_wrong_hits == 0 && result.model.wrong_hits == 0;
  fmt::print("{:<18} {:<9} {:>6} {:>9} {:>11} {:>5}  {}{}{}\n", config.build, trace, result.model.rays, result.cycles,
             result.handshakes, agree ? 0 : 1, config.settings, ways_of(config),
             config.stall_seed != 0 ? " stalled at random" : "");
  if (result.difference) fmt::print("  {}\n", to_string(*result.difference));
  if (result.rtl_wrong_hits + result.model.wrong_hits != 0)
    fmt::print("  wrong hits: model {}, rtl {}\n", result.model.wrong_hits, result.rtl_wrong_hits);
  std::fflush(stdout);
  ++totals.runs;
  totals.rays += result.model.rays;
  totals.cycles += result.cycles;
  totals.handshakes += result.handshakes;
  totals.compared += result.compared;
  totals.differences += !agree;
  return result;
}

/// Compares with the baseline, or puts the run into it.
void judge(const Arguments& arguments, std::optional<Baseline>& baseline, const std::string& key,
           const LockStepResult& result, Totals& totals) {
  if (!baseline || result.difference) return;
  if (arguments.update) {
    baseline->set(key, result.cycles);
    return;
  }
  const std::string complaint = baseline->complaint(key, result.cycles);
  if (complaint.empty()) return;
  fmt::print("  {} {}\n", key, complaint);
  ++totals.differences;
}

int run_grid(const Arguments& arguments) {
  fmt::print("seed {} (CTU_TEST_SEED repeats it)\n", oracle::test_seed());
  fmt::print("{:<18} {:<9} {:>6} {:>9} {:>11} {:>5}  settings\n", "build", "trace", "rays", "cycles", "handshakes",
             "diff.");
  Worlds worlds;
  Totals totals;
  std::size_t configs = 0;
  std::optional<Baseline> baseline;
  if (!arguments.baseline.empty()) baseline.emplace(arguments.baseline);
  for (const GridConfig& config : grid_configs()) {
    if (arguments.quick && !config.quick) continue;
    if ((config.build + " " + config.settings).find(arguments.only) == std::string::npos) continue;
    const auto unit = load_rtl_unit(arguments.folder + "/" + config.build + ".so");
    ++configs;
    const std::string hash = sim::config_hash(unit_config(unit->parameters(), config.settings));
    for (const std::string& trace : grid_traces()) {
      test::World& world = worlds.get(trace, unit->parameters(), arguments.rays, config);
      if (world.rays() == 0) continue;  // shadow rays begin on surfaces, where no reachable row serves
      const LockStepResult result = run(config, trace, *unit, world, totals);
      const std::string key = fmt::format("{} {}{}{},{},{}", hash, config.build, ways_of(config),
                                          config.stall_seed == 0 ? "" : fmt::format(" stalls {}", config.stall_seed),
                                          trace, result.model.rays);
      judge(arguments, baseline, key, result, totals);
    }
  }
  if (arguments.update) baseline->write();
  fmt::print(
      "{} configurations, {} traces, {} rays, {} cycles, {} handshakes and {} signals compared, differences: {}\n",
      configs, grid_traces().size(), totals.rays, totals.cycles, totals.handshakes, totals.compared,
      totals.differences);
  return totals.runs == 0 || totals.differences != 0 ? 1 : 0;
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick")
      arguments.quick = true;
    else if (word == "--rays" && i + 1 < argc)
      arguments.rays = std::stoi(argv[++i]);
    else if (word == "--update")
      arguments.update = true;
    else if (word == "--baseline" && i + 1 < argc)
      arguments.baseline = argv[++i];
    else if (word == "--only" && i + 1 < argc)
      arguments.only = argv[++i];
    else
      arguments.folder = word;
  }
  if (arguments.update && arguments.baseline.empty())
    throw Error("--update", "no file to update", "add --baseline FILE");
  if (arguments.folder.empty()) throw Error("ctu_grid", "no folder of builds", "ctu_grid build/release/rtl [--quick]");
  return arguments;
}

}  // namespace
}  // namespace ctu::cosim

int main(int argc, char** argv) {
  try {
    return ctu::cosim::run_grid(ctu::cosim::parse(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
