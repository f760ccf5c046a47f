// Where cycles go, and what two parameters do together.
#pragma once

#include <vector>

#include "sim/report/chart.h"

namespace ctu::report {

/// Busy, stalled by cause and idle of every stage; and by scene and design where the time and the energy of a ray go
/// and what is on chip. Means over the rows shown.
std::vector<Chart> share_charts(const Results& results);

/// Cycles over the scene's best for each pair of the parameters that change cycles most.
std::vector<Chart> heat_maps(const Results& results);

}  // namespace ctu::report
