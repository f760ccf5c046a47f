// Timing of a unit, drawn: nothing in it may change an answer (contract 3).
#pragma once

#include "model/pipeline/unit_config.h"
#include "sim/check/case_random.h"

namespace ctu::sim::check {

/// Contexts, caches, memory, intervals and stack; caches of the tables too where `with_tables`.
void draw_timing(CaseRandom& random, bool with_tables, pipeline::UnitConfig& config);

/// The same without long waits, for the unit in gates, where every cycle costs: most of what a build leaves open.
void draw_short_timing(CaseRandom& random, pipeline::UnitConfig& config);

}  // namespace ctu::sim::check
