// Longest paths through a netlist, in gates.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/area/module_area.h"

namespace ctu::area {

/// The combinational part of one module: nets by number, and what joins them.
class PathGraph {
 public:
  using Nets = std::vector<std::uint32_t>;

  void add_input(const std::string& port, Nets nets) { inputs_[port] = std::move(nets); }
  void add_output(const std::string& port, Nets nets) { outputs_[port] = std::move(nets); }
  /// `to` follows from `from`, `gates` later.
  void add_logic(const Nets& from, const Nets& to, int gates);
  /// `nets` leave a register that lies `gates` before them; enter one that lies `gates` behind them.
  void add_launch(const Nets& nets, int gates);
  void add_capture(const Nets& nets, int gates);
  /// All of a module that stands inside this one; `nets` of each of its ports.
  void add_module(const PortPaths& paths, const std::map<std::string, Nets>& nets);

  /// `inside`: the longest path within the modules inside this one.
  PortPaths longest_paths(int inside = 0) const;

 private:
  struct Arc {
    Nets from;
    int gates;
  };
  struct Node {
    std::vector<Arc> arcs;
    Nets to;
  };
  struct Timed {
    Nets nets;
    int gates;
  };

  std::uint32_t net_count() const;
  std::vector<std::uint32_t> sorted_nodes(bool& has_loops) const;
  void arrive(std::vector<int>& level, const std::vector<std::uint32_t>& order) const;
  int captured(const std::vector<int>& level) const;

  std::vector<Node> nodes_;
  std::vector<Timed> launches_, captures_;
  std::map<std::string, Nets> inputs_, outputs_;
};

}  // namespace ctu::area
