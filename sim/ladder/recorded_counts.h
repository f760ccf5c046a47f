// What a trace knows of its rays without their steps, and how sums of a part become sums of the whole.
#pragma once

#include <string>

#include "sim/ladder/trace_work.h"

namespace ctu::ladder {

/// The whole trace's counts of the tester's design, when the work is the whole trace and it has them; else null.
const reference::Counts* recorded_counts(const TraceWork& work);

/// Each count times `factor`, of so many rays.
reference::Counts scaled_counts(const reference::Counts& counts, double factor, std::uint64_t rays);

/// Whether a counter is no sum: a maximum, or a size.
bool is_extreme(const std::string& name);

}  // namespace ctu::ladder
