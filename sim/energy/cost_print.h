// The costs of a run for people.
#pragma once

#include "sim/energy/cost_report.h"

namespace ctu::energy {

/// Energy of a ray by stage, bits on chip by stage, area.
void print_cost(const CostReport& report);

}  // namespace ctu::energy
