#include "sim/tailor/check.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/config_file.h"
#include "sim/cosim/lock_step.h"
#include "sim/cosim/rtl_builds.h"
#include "sim/tailor/gate_build.h"
#include "sim/unit_runner.h"

namespace ctu::tailor {
namespace {

/// The unit in gates beside the model, from the libraries of a folder; empty: those beside the program.
GateCheck run_gates(const sim::LoadedTrace& trace, const pipeline::UnitConfig& config, std::uint64_t rays,
                    const std::string& folder) {
  const cull::MaskTester tester = trace.tester(config.mask_test.design);
  const accel::Image image = trace.unit_image(config.mask_test.design);
  // From the middle, where a picture has its scene; packets must not be cut.
  const std::uint64_t all = trace.reader().rays();
  const bool from_begin = rays >= all || trace.reader().manifest().packets.any();
  const traces::RayRange range = trace.range(from_begin ? 0 : (all - rays) / 2, rays);
  traces::TraceFeed model_feed(trace.reader(), range), gate_feed(trace.reader(), range);
  const pipeline::Work model_work{image, tester, model_feed}, gate_work{image, tester, gate_feed};
  const auto unit = cosim::make_rtl_unit(config, gate_work, folder);
  const cosim::LockStepResult result = cosim::run_lock_step(*unit, config, model_work, gate_work, {});
  GateCheck check;
  check.trace = trace.reader().path();
  check.rays = result.model.rays;
  check.cycles = result.model.cycles;
  check.handshakes = result.handshakes;
  check.wrong_hits = std::max(result.model.wrong_hits, result.rtl_wrong_hits);
  if (result.difference) check.difference = cosim::to_string(*result.difference);
  return check;
}

}  // namespace

std::vector<sim::RunRecord> run_whole(Workbench& bench, const pipeline::UnitConfig& config) {
  std::vector<sim::RunRecord> records;
  for (std::size_t i = 0; i < bench.traces(); ++i) {
    sim::RunPlan plan;
    plan.config = config;
    plan.range = bench.trace(i).range(0, 0);
    records.push_back(sim::run_plan(bench.trace(i), plan));
  }
  return records;
}

double cycles_ratio(const sim::RunRecord& before, const sim::RunRecord& after) {
  return static_cast<double>(after.result.cycles) / static_cast<double>(before.result.cycles);
}

double slowest_ratio(const std::vector<sim::RunRecord>& before, const std::vector<sim::RunRecord>& after) {
  double slowest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) slowest = std::max(slowest, cycles_ratio(before[i], after[i]));
  return slowest;
}

std::vector<GateCheck> check_gates(Workbench& bench, const pipeline::UnitConfig& config, const UnitParts& parts,
                                   std::uint64_t rays, bool build) {
  std::vector<GateCheck> checks;
  std::string folder;
  for (std::size_t i = 0; i < bench.traces(); ++i) {
    const sim::LoadedTrace& trace = bench.trace(i);
    try {
      checks.push_back(run_gates(trace, config, rays, folder));
    } catch (const Error& error) {
      if (!build || !folder.empty()) {
        checks.push_back({trace.reader().path(), 0, 0, 0, 0, "",
                          fmt::format("no build of the unit in gates at hand is this one{}",
                                      build ? ": " + error.problem() : "; --build-rtl makes it")});
        continue;
      }
      const std::string name = "tailored-" + sim::config_hash(config).substr(0, 8);
      fmt::print(stderr, "building the unit in gates: {}\n", name);
      folder = build_gates(name, gate_build_line(name, config, parts)).string();
      --i;
    }
  }
  return checks;
}

}  // namespace ctu::tailor
