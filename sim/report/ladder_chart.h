// Error against run time, as `ctusim ladder` measured it.
#pragma once

#include <vector>

#include "sim/report/chart.h"

namespace ctu::report {

/// Of ladder.json, which `ctusim ladder --out` writes: a point for each engine and configuration. None without one.
std::vector<Chart> ladder_charts(const Results& results);

}  // namespace ctu::report
