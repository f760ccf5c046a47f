// An AreaReport as text for other programs.
#pragma once

#include <string>

#include "sim/area/area_report.h"

namespace ctu::area {

/// `hash` names the configuration (config_hash), `parameters` are those of the RTL.
std::string area_json(const AreaReport& report, const std::string& hash, const RtlParameters& parameters);

}  // namespace ctu::area
