// The section [parts] of a configuration file: what its unit was built with (sim/tailor/unit_parts.h).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "model/pipeline/parameter.h"
#include "model/pipeline/unit_config.h"

namespace ctu::sim {

using PartValues = std::map<std::string, pipeline::ParameterValue>;

/// As load_config, which refuses a file with [parts]; here they go to `parts`, by their names without the section's.
pipeline::UnitConfig load_config_with_parts(const std::string& path, const std::vector<std::string>& sets,
                                            PartValues& parts);

}  // namespace ctu::sim
