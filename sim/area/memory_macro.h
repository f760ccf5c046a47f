// Modules that are memories though their RTL cannot be read as one.
#pragma once

#include <optional>
#include <string>

#include "sim/area/elaboration.h"
#include "sim/area/module_area.h"

namespace ctu::area {

/// rtl/line_buffer.sv, the fetched lines by context: a line from memory is written for many contexts at once, which
/// makes registers of it all, a hundred thousand of them and their multiplexers. Silicon would take memories with a
/// write mask, so it counts as its bits; what picks words out of lines is not counted. None for every other module.
std::optional<ModuleArea> memory_macro(const std::string& name, const ElaboratedModule& module);

}  // namespace ctu::area
