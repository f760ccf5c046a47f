// A build of the unit in gates for one configuration, where none of those at hand fits: the lines that
// sim/cosim/builds.cmake has for its own, made by the same machinery in a folder of the user's cache.
#pragma once

#include <filesystem>
#include <string>

#include "model/pipeline/unit_config.h"
#include "sim/area/yosys.h"
#include "sim/tailor/unit_parts.h"

namespace ctu::tailor {

/// The parameters of the RTL that make this unit, no larger than the configuration and its parts need. Throws Error
/// when the RTL does not have what they ask for.
area::RtlParameters gate_parameters(const pipeline::UnitConfig& config, const UnitParts& parts);

/// The same as `ctu_rtl_build(NAME PARAMETER value ...)`.
std::string gate_build_line(const std::string& name, const pipeline::UnitConfig& config, const UnitParts& parts);

/// The folder with the library of that line, made by cmake and verilator unless it is there; minutes. Throws Error when
/// they fail, naming their log.
std::filesystem::path build_gates(const std::string& name, const std::string& line);

}  // namespace ctu::tailor
