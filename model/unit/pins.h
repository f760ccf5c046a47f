// Pins mode: one SC_MODULE a stage, ready/valid signals between them.
#pragma once

#include "model/pipeline/engine.h"

namespace ctu::unit {

/// The same stages and links as the plain pipeline, joined by sc_signals under an sc_clock of one nanosecond: about
/// seven times slower, the same cycles. Of the options, skip_idle, reverse_order and keep_events do not apply.
pipeline::UnitResult run_pins(const pipeline::UnitConfig& config, const pipeline::Work& work,
                              const pipeline::EngineOptions& options);

}  // namespace ctu::unit
