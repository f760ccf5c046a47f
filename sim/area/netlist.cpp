#include "sim/area/netlist.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "sim/area/elaboration.h"
#include "sim/area/path_graph.h"

namespace ctu::area {
namespace {

using nlohmann::json;
using Nets = PathGraph::Nets;

constexpr const char* kMemory = "$mem_v2";

/// Constants are texts and belong to no path.
Nets nets_of(const json& bits, std::size_t first = 0, std::size_t count = std::size_t(-1)) {
  Nets nets;
  for (std::size_t i = first; i < bits.size() && i - first < count; ++i)
    if (bits[i].is_number()) nets.push_back(bits[i].get<std::uint32_t>());
  return nets;
}

/// A parameter is a text of binary digits.
std::uint64_t parameter(const json& cell, const char* name) {
  return std::stoull(cell.at("parameters").at(name).get<std::string>(), nullptr, 2);
}

/// Digit `bit` of a parameter, from its right end.
bool parameter_bit(const json& cell, const char* name, std::size_t bit) {
  const auto& text = cell.at("parameters").at(name).get_ref<const std::string&>();
  return bit < text.size() && text[text.size() - 1 - bit] == '1';
}

MemoryShape memory_shape(const json& cell) {
  return {parameter(cell, "SIZE"), static_cast<std::uint32_t>(parameter(cell, "WIDTH")),
          static_cast<std::uint32_t>(parameter(cell, "RD_PORTS")),
          static_cast<std::uint32_t>(parameter(cell, "WR_PORTS"))};
}

class NetlistReader {
 public:
  NetlistReader(const json& modules, Target target, const InnerPaths& inner)
      : modules_(modules), target_(target), inner_(inner) {}

  std::map<std::string, ModuleArea> read_all() {
    for (const auto& [name, module] : modules_.items())
      if (!is_box(module)) read(name);
    return std::move(areas_);
  }

 private:
  /// Boxes of the target's own library may stand in the netlist too.
  static bool is_box(const json& module) {
    const json& attributes = module.at("attributes");
    return attributes.contains("blackbox") || attributes.contains("whitebox");
  }
  /// Null when the type is a cell.
  const PortPaths* paths_of(const std::string& type) {
    if (modules_.contains(type) && !is_box(modules_.at(type))) return &read(type).paths;
    return inner_(type);
  }

  const ModuleArea& read(const std::string& name) {
    if (const auto found = areas_.find(name); found != areas_.end()) return found->second;
    const json& module = modules_.at(name);
    ModuleArea area;
    PathGraph graph;
    int inside = 0;
    for (const auto& [port, value] : module.at("ports").items())
      if (value.at("direction") == "input")
        graph.add_input(port, nets_of(value.at("bits")));
      else
        graph.add_output(port, nets_of(value.at("bits")));
    for (const auto& [cell_name, cell] : module.at("cells").items()) {
      const auto& type = cell.at("type").get_ref<const std::string&>();
      if (const PortPaths* const paths = paths_of(type)) {
        ++area.instances[type];
        inside = std::max(inside, paths->inside);
        if (target_ == Target::Gates) add_instance(graph, *paths, cell);
      } else if (type == kMemory) {
        ++area.memories[memory_shape(cell)];
        add_memory(graph, cell);
      } else {
        ++area.cells[type];
        if (target_ == Target::Gates) add_gate(graph, name, type, cell);
      }
    }
    if (target_ == Target::Gates) area.paths = graph.longest_paths(inside);
    return areas_[name] = std::move(area);
  }

  static void add_instance(PathGraph& graph, const PortPaths& paths, const json& cell) {
    std::map<std::string, Nets> nets;
    for (const auto& [port, bits] : cell.at("connections").items()) nets[port] = nets_of(bits);
    graph.add_module(paths, nets);
  }

  static void add_gate(PathGraph& graph, const std::string& module, const std::string& type, const json& cell) {
    if (centigates(type) < 0)
      throw Error("yosys", fmt::format("has left a cell {} in {}", type, plain_name(module)),
                  "that is a mistake in rtl/, or a yosys that this program does not know");
    const bool registers = is_flip_flop(type);
    Nets from, to;
    for (const auto& [port, bits] : cell.at("connections").items()) {
      Nets& side = cell.at("port_directions").at(port) == "output" ? to : from;
      if (registers && port == "C") continue;
      const Nets nets = nets_of(bits);
      side.insert(side.end(), nets.begin(), nets.end());
    }
    if (!registers) return graph.add_logic(from, to, 1);
    graph.add_launch(to, 0);
    graph.add_capture(from, 0);
  }

  /// A memory's read without a clock counts as one gate.
  static void add_memory(PathGraph& graph, const json& cell) {
    const json& nets = cell.at("connections");
    for (const char* port : {"WR_ADDR", "WR_DATA", "WR_EN", "RD_EN", "RD_ARST", "RD_SRST"})
      graph.add_capture(nets_of(nets.at(port)), 0);
    const std::size_t width = parameter(cell, "WIDTH"), address_bits = parameter(cell, "ABITS");
    for (std::size_t port = 0; port < parameter(cell, "RD_PORTS"); ++port) {
      const Nets address = nets_of(nets.at("RD_ADDR"), port * address_bits, address_bits);
      const Nets data = nets_of(nets.at("RD_DATA"), port * width, width);
      if (parameter_bit(cell, "RD_CLK_ENABLE", port)) {
        graph.add_capture(address, 0);
        graph.add_launch(data, 0);
      } else {
        graph.add_launch(data, 1);
        graph.add_logic(address, data, 1);
      }
    }
  }

  const json& modules_;
  Target target_;
  const InnerPaths& inner_;
  std::map<std::string, ModuleArea> areas_;
};

}  // namespace

std::map<std::string, ModuleArea> read_netlist(const std::string& text, Target target, const InnerPaths& inner) {
  const json netlist = json::parse(text);
  return NetlistReader(netlist.at("modules"), target, inner).read_all();
}

}  // namespace ctu::area
