// The checks of a tailored unit: all rays in the model, some of them in gates beside it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/pipeline/unit_config.h"
#include "sim/run_record.h"
#include "sim/tailor/unit_parts.h"
#include "sim/tailor/workbench.h"

namespace ctu::tailor {

/// Every ray of every trace in the timed model.
std::vector<sim::RunRecord> run_whole(Workbench& bench, const pipeline::UnitConfig& config);

/// Cycles over cycles of the same rays.
double cycles_ratio(const sim::RunRecord& before, const sim::RunRecord& after);
/// The largest of the traces' ratios of cycles.
double slowest_ratio(const std::vector<sim::RunRecord>& before, const std::vector<sim::RunRecord>& after);

/// Rays from a trace's middle in lock step.
struct GateCheck {
  std::string trace;
  std::uint64_t rays = 0, cycles = 0, handshakes = 0, wrong_hits = 0;
  std::string difference;  ///< empty: none
  std::string not_run;     ///< why it was not run; then the rest says nothing
};

/// Where no build at hand fits, one is made if `build`; otherwise the check says so.
std::vector<GateCheck> check_gates(Workbench& bench, const pipeline::UnitConfig& config, const UnitParts& parts,
                                   std::uint64_t rays, bool build);

}  // namespace ctu::tailor
