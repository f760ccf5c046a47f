// What yosys has made of modules: its JSON netlist.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "sim/area/module_area.h"

namespace ctu::area {

/// Paths of a module that the netlist does not hold itself; null when there is no such module: a cell of the target.
using InnerPaths = std::function<const PortPaths*(const std::string& module)>;

/// Cost of each module of the netlist. Throws Error when yosys has left a cell that the target does not have.
std::map<std::string, ModuleArea> read_netlist(const std::string& json, Target target, const InnerPaths& inner);

}  // namespace ctu::area
