// A Pareto-guided search through a space, with a random one of the same budget beside it.
#pragma once

#include "sim/sweep/sweep_run.h"

namespace ctu::sweep {

/// Runs generation after generation, then the random draws, prints both fronts and how much each covers, and writes
/// them to search.json. An objective is a column of the results; over several traces it is the geometric mean. Returns
/// before the end, without a word, when it was stopped. Throws Error when no result has such a column.
void search(SweepRun& run);

}  // namespace ctu::sweep
