// A configuration file that may name the parts its unit was built with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/pipeline/unit_config.h"
#include "sim/tailor/unit_parts.h"

namespace ctu::sim {

struct TailoredConfig {
  pipeline::UnitConfig config;
  std::optional<tailor::UnitParts> parts;  ///< none: the unit has whatever a trace needs
};

/// As load_config, and with the section [parts] that load_config refuses.
TailoredConfig load_tailored_config(const std::string& path, const std::vector<std::string>& sets);

}  // namespace ctu::sim
