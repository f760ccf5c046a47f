// The builds of the RTL unit that are at hand, and which of them can run a configuration.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/pipeline/work.h"
#include "sim/cosim/rtl_unit.h"

namespace ctu::cosim {

/// Why the build cannot run this; empty when it can.
std::string misfit(const RtlParameters& build, const pipeline::UnitConfig& config, const pipeline::Work& work);

/// The configuration with what the build fixes; the rest as it is by default.
pipeline::UnitConfig config_of(const RtlParameters& build);

/// The libraries of the builds at hand, by name; where they lie is said at make_rtl_unit.
std::vector<std::string> rtl_libraries(const std::string& folder = {});

/// A unit of the first build that can; libraries lie in the folder `rtl` beside the program, or where `folder` says.
/// Throws Error that says of each build what does not fit.
std::unique_ptr<RtlUnit> make_rtl_unit(const pipeline::UnitConfig& config, const pipeline::Work& work,
                                       const std::string& folder = {});
/// The unit of one library. Throws Error when it cannot be loaded, or was built from other sources than this program.
std::unique_ptr<RtlUnit> load_rtl_unit(const std::string& library);

}  // namespace ctu::cosim
