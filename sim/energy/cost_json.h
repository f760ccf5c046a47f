// The costs of a run as they stand in its result file.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/energy/cost_report.h"

namespace ctu::energy {

/// What stands for an area that is not known.
inline constexpr const char* kAreaUnknown = "unknown: run ctusim area";

/// Keys `energy` (with the run's counters only), `energy_per_ray_pj`, `on_chip_bits`, `on_chip`, `area_memory_um2`,
/// `area_gate_equivalents` and `area_um2`.
nlohmann::ordered_json cost_json(const CostReport& report);

}  // namespace ctu::energy
