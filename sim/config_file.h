// The unit's configuration as users write it: a TOML file, `--set key=value` over it, and both resolved.
#pragma once

#include <string>
#include <vector>

#include "model/pipeline/parameter.h"
#include "model/pipeline/unit_config.h"

namespace ctu::sim {

/// Defaults, then the file (when `path` is not empty), then each "key=value" of `sets`. An unknown key, a wrong type
/// or a value out of range is an Error naming file and line (or --set), the nearest known key, and what is allowed.
pipeline::UnitConfig load_config(const std::string& path, const std::vector<std::string>& sets);

/// The whole configuration as TOML that load_config reads back; with each parameter's unit, range and meaning as
/// comments when `documented`.
std::string config_to_toml(const pipeline::UnitConfig& config, bool documented);

/// Identity of a resolved configuration: 32 hexadecimal digits, the same on every machine.
std::string config_hash(const pipeline::UnitConfig& config);

std::string to_text(const pipeline::ParameterValue& value);

}  // namespace ctu::sim
