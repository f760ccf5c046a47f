// Runs of the unit in gates: alone, or beside the model.
#pragma once

#include "sim/loaded_trace.h"
#include "sim/run_record.h"
#include "sim/unit_runner.h"

namespace ctu::sim {

/// Engine "rtl". Error when no build of the unit fits.
pipeline::UnitResult run_rtl(const LoadedTrace& trace, const cull::MaskTester& tester, const RunPlan& plan);

/// Engine "both": every handshake of every link and the account of every stage compared in every cycle; behind a
/// difference both waveforms around it are written. The result is the model's.
pipeline::UnitResult run_both(const LoadedTrace& trace, const cull::MaskTester& tester, const RunPlan& plan,
                              TwinComparison& comparison);

}  // namespace ctu::sim
