#include "sim/area/module_area.h"

#include <algorithm>
#include <string_view>

namespace ctu::area {
namespace {

constexpr int kFlipFlop = 567, kEnable = 233, kReset = 133;

const std::map<std::string_view, int>& gates() {
  static const std::map<std::string_view, int> table = {
      {"$_BUF_", 100},    {"$_NOT_", 67},    {"$_NAND_", 100}, {"$_NOR_", 100},  {"$_AND_", 133}, {"$_OR_", 133},
      {"$_ANDNOT_", 133}, {"$_ORNOT_", 133}, {"$_XOR_", 200},  {"$_XNOR_", 200}, {"$_MUX_", 233}, {"$_NMUX_", 233},
      {"$_AOI3_", 133},   {"$_OAI3_", 133},  {"$_AOI4_", 167}, {"$_OAI4_", 167},
  };
  return table;
}

/// Cost of a flip-flop by the first part of its type's name; -1 when it is none.
int flip_flop(std::string_view type) {
  static const std::map<std::string_view, int> table = {
      {"$_DFF", kFlipFlop},
      {"$_DFFE", kFlipFlop + kEnable},
      {"$_SDFF", kFlipFlop + kReset},
      {"$_SDFFE", kFlipFlop + kEnable + kReset},
      {"$_SDFFCE", kFlipFlop + kEnable + kReset},
  };
  const auto end = type.find('_', 2);
  const auto found = table.find(type.substr(0, end));
  return end == std::string_view::npos || found == table.end() ? -1 : found->second;
}

template <class Map>
int largest(const Map& paths) {
  int most = 0;
  for (const auto& [from_to, length] : paths) most = std::max(most, length);
  return most;
}

}  // namespace

int PortPaths::longest() const { return std::max({inside, largest(capture), largest(launch), largest(pass)}); }

bool is_flip_flop(const std::string& type) { return flip_flop(type) >= 0; }

int centigates(const std::string& type) {
  const auto gate = gates().find(type);
  return gate == gates().end() ? flip_flop(type) : gate->second;
}

}  // namespace ctu::area
