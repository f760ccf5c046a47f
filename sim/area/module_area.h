// What one module of the RTL costs by itself, without the modules inside it.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace ctu::area {

/// What a netlist is made of.
enum class Target : std::uint8_t {
  Gates,  ///< two-input gates, multiplexers and flip-flops; memories stay whole
  Ecp5,   ///< LUT4, carry chains, multipliers and block RAM of the Lattice ECP5 family
};

struct MemoryShape {
  std::uint64_t words = 0;
  std::uint32_t width = 0;
  std::uint32_t read_ports = 0, write_ports = 0;
  std::uint64_t bits() const { return words * width; }
  auto operator<=>(const MemoryShape&) const = default;
};

/// The longest paths between a module's ports and registers, in gates, with the modules inside it. A port of several
/// bits counts as one: paths that meet in it are joined though they may go through other bits of it.
struct PortPaths {
  int inside = 0;                                           ///< from register to register
  std::map<std::string, int> capture;                       ///< from an input to a register
  std::map<std::string, int> launch;                        ///< from a register to an output
  std::map<std::pair<std::string, std::string>, int> pass;  ///< from an input to an output
  bool has_loops = false;  ///< cut somewhere, as ports of several bits count as one: paths may be longer
  /// The longest of them all.
  int longest() const;
  bool operator==(const PortPaths&) const = default;
};

struct ModuleArea {
  std::map<std::string, std::uint64_t> cells;  ///< by type, of the target
  std::map<MemoryShape, std::uint64_t> memories;
  std::map<std::string, std::uint64_t> instances;  ///< by name of the module
  PortPaths paths;                                 ///< Target::Gates only
  bool operator==(const ModuleArea&) const = default;
};

/// NAND2 gates that a cell of Target::Gates is worth, in hundredths, as sizes in an open 45 nm library go: an inverter
/// 0.67, XOR 2, a multiplexer 2.33, a flip-flop 5.67, its enable a multiplexer more, its reset an AND more. -1 when the
/// type is not one of these.
int centigates(const std::string& type);
bool is_flip_flop(const std::string& type);

}  // namespace ctu::area
