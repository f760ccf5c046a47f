#include "sim/area/path_graph.h"

#include <algorithm>

namespace ctu::area {
namespace {

constexpr int kNever = -1;  ///< nothing arrives at this net

int last_of(const PathGraph::Nets& nets, const std::vector<int>& level) {
  int last = kNever;
  for (const std::uint32_t net : nets) last = std::max(last, level[net]);
  return last;
}

void raise(std::vector<int>& level, const PathGraph::Nets& nets, int to) {
  for (const std::uint32_t net : nets) level[net] = std::max(level[net], to);
}

void keep_most(std::uint32_t& most, const PathGraph::Nets& nets) {
  for (const std::uint32_t net : nets) most = std::max(most, net);
}

}  // namespace

void PathGraph::add_logic(const Nets& from, const Nets& to, int gates) { nodes_.push_back({{{from, gates}}, to}); }

void PathGraph::add_launch(const Nets& nets, int gates) { launches_.push_back({nets, gates}); }

void PathGraph::add_capture(const Nets& nets, int gates) { captures_.push_back({nets, gates}); }

void PathGraph::add_module(const PortPaths& paths, const std::map<std::string, Nets>& nets) {
  const auto of = [&](const std::string& port) {
    const auto found = nets.find(port);
    return found == nets.end() ? Nets{} : found->second;
  };
  for (const auto& [port, gates] : paths.capture) add_capture(of(port), gates);
  for (const auto& [port, gates] : paths.launch) add_launch(of(port), gates);
  std::map<std::string, Node> by_output;
  for (const auto& [ports, gates] : paths.pass) {
    Node& node = by_output[ports.second];
    node.arcs.push_back({of(ports.first), gates});
    node.to = of(ports.second);
  }
  for (auto& [port, node] : by_output) nodes_.push_back(std::move(node));
}

std::uint32_t PathGraph::net_count() const {
  std::uint32_t most = 0;
  for (const Node& node : nodes_) {
    keep_most(most, node.to);
    for (const Arc& arc : node.arcs) keep_most(most, arc.from);
  }
  for (const auto* list : {&launches_, &captures_})
    for (const Timed& timed : *list) keep_most(most, timed.nets);
  for (const auto* ports : {&inputs_, &outputs_})
    for (const auto& [port, nets] : *ports) keep_most(most, nets);
  return most + 1;
}

std::vector<std::uint32_t> PathGraph::sorted_nodes(bool& has_loops) const {
  // Who reads each net, and how many inputs of each node are still to come.
  std::vector<std::vector<std::uint32_t>> readers(net_count());
  std::vector<bool> driven(readers.size(), false);
  std::vector<std::uint32_t> missing(nodes_.size(), 0);
  for (const Node& node : nodes_)
    for (const std::uint32_t net : node.to) driven[net] = true;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n)
    for (const Arc& arc : nodes_[n].arcs)
      for (const std::uint32_t net : arc.from)
        if (driven[net]) {
          readers[net].push_back(n);
          ++missing[n];
        }
  std::vector<std::uint32_t> order;
  std::vector<bool> taken(nodes_.size(), false);
  const auto take = [&](std::uint32_t node) {
    taken[node] = true;
    order.push_back(node);
  };
  for (std::uint32_t n = 0; n < nodes_.size(); ++n)
    if (missing[n] == 0) take(n);
  std::uint32_t looped = 0;
  for (std::size_t done = 0; order.size() < nodes_.size() || done < order.size(); ++done) {
    if (done == order.size()) {  // only loops are left: one is cut at its first node
      while (taken[looped]) ++looped;
      has_loops = true;
      take(looped);
    }
    for (const std::uint32_t net : nodes_[order[done]].to)
      for (const std::uint32_t reader : readers[net])
        if (!taken[reader] && --missing[reader] == 0) take(reader);
  }
  return order;
}

void PathGraph::arrive(std::vector<int>& level, const std::vector<std::uint32_t>& order) const {
  for (const std::uint32_t n : order) {
    int last = kNever;
    for (const Arc& arc : nodes_[n].arcs)
      if (const int from = last_of(arc.from, level); from != kNever) last = std::max(last, from + arc.gates);
    raise(level, nodes_[n].to, last);
  }
}

int PathGraph::captured(const std::vector<int>& level) const {
  int last = kNever;
  for (const Timed& capture : captures_)
    if (const int from = last_of(capture.nets, level); from != kNever) last = std::max(last, from + capture.gates);
  return last;
}

PortPaths PathGraph::longest_paths(int inside) const {
  PortPaths paths;
  const std::vector<std::uint32_t> order = sorted_nodes(paths.has_loops);
  std::vector<int> level(net_count(), kNever);
  for (const Timed& launch : launches_) raise(level, launch.nets, launch.gates);
  arrive(level, order);
  paths.inside = std::max(inside, captured(level));
  for (const auto& [port, nets] : outputs_)
    if (const int last = last_of(nets, level); last != kNever) paths.launch[port] = last;
  for (const auto& [input, nets] : inputs_) {
    std::fill(level.begin(), level.end(), kNever);
    raise(level, nets, 0);
    arrive(level, order);
    if (const int last = captured(level); last != kNever) paths.capture[input] = last;
    for (const auto& [output, ends] : outputs_)
      if (const int last = last_of(ends, level); last != kNever) paths.pass[{input, output}] = last;
  }
  return paths;
}

}  // namespace ctu::area
