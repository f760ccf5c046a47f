// Batch and cycle mode: one SC_MODULE owns the whole pipeline and advances it a number of cycles per activation.
#pragma once

#include "model/pipeline/engine.h"

namespace ctu::unit {

/// Runs the engine under SystemC, `cycles_per_activation` cycles each time its event comes; one cycle is one
/// nanosecond. Exact for any number, as nothing outside the batch answers. One SystemC simulation at a time in a
/// process.
pipeline::UnitResult run_ticking(pipeline::Engine& engine, pipeline::Cycle cycles_per_activation);

}  // namespace ctu::unit
