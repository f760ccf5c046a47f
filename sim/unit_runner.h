// One run of the unit on a loaded trace, from words of the command line to a RunRecord.
#pragma once

#include <optional>
#include <string>

#include "model/unit/run.h"
#include "sim/commands.h"
#include "sim/energy/energy_table.h"
#include "sim/ladder/sampled.h"
#include "sim/loaded_trace.h"
#include "sim/run_record.h"
#include "sim/tailor/unit_parts.h"

namespace ctu::sim {

/// "plain", "batch", "cycle", "pins"; "replay", "exec". Error on anything else.
unit::Mode parse_mode(const std::string& name);
unit::Source parse_source(const std::string& name);
/// Mode and source.
unit::RunOptions run_options(const UnitArgs& args);

/// Error on what is no engine of run_plan.
void require_engine(const std::string& engine);

struct RunPlan {
  std::string engine = "cycle";  ///< or "reference", "rtl", "both", "estimate", "sampled"
  pipeline::UnitConfig config;
  unit::RunOptions options;
  traces::RayRange range;
  energy::EnergyTable energy = energy::EnergyTable::standard();
  std::optional<tailor::UnitParts> parts;  ///< that the unit was built with; none: what the trace needs
  ladder::SampledOptions sampled;
};

/// Runs and times it; loading and table building are not part of the time.
RunRecord run_plan(const LoadedTrace& trace, const RunPlan& plan);

}  // namespace ctu::sim
