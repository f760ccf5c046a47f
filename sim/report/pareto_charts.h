// Cycles against what they cost: on-chip bits, area, energy, and the size of the mask test's tables.
#pragma once

#include <vector>

#include "sim/report/chart.h"

namespace ctu::report {

/// A point for each row, and for each scene the staircase of points that no other beats in both.
std::vector<Chart> pareto_charts(const Results& results);

/// Intersections and the fewest cycles at each size of the mask test's tables, a line for each scene, design and R.
std::vector<Chart> table_size_charts(const Results& results);

}  // namespace ctu::report
