// What a unit costs, stage by stage: the result of `ctusim area`, and what a sweep weighs against cycles.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/area/module_area.h"
#include "sim/area/yosys.h"

namespace ctu::area {

/// Cells of the FPGA family.
struct FpgaArea {
  std::uint64_t lut4 = 0;  ///< a bit of a carry chain takes one, four bits of RAM made of them two
  std::uint64_t flip_flops = 0;
  std::uint64_t dsps = 0;        ///< multipliers of 18 x 18 bits
  std::uint64_t block_rams = 0;  ///< of 18 kbit
};

/// A stage, or all of them: everything with the modules inside, each as often as it is there.
struct Area {
  std::uint64_t gates = 0;  ///< generic cells, flip-flops left out
  std::uint64_t flip_flops = 0;
  double gate_equivalents = 0;                    ///< of both, in NAND2 gates (`centigates`)
  std::map<MemoryShape, std::uint64_t> memories;  ///< not part of the above
  int depth = 0;                                  ///< longest path between registers or ports, in gates
  FpgaArea fpga;                                  ///< zero unless asked for; RAM included
  std::uint64_t memory_bits() const;
};

struct StageArea {
  std::string module;
  std::uint64_t instances = 0;  ///< of it in the unit, whatever their parameters are
  Area area;                    ///< of all of these
};

struct AreaReport {
  std::vector<StageArea> stages;  ///< by name; links and register files of the contexts as well
  Area total;
  std::uint64_t synthesised = 0, cached = 0;  ///< modules, by where they came from
};

struct AreaJob {
  std::filesystem::path rtl;  ///< folder of the sources, and folders in it
  std::string top = "ctu_unit";
  RtlParameters parameters;
  std::vector<std::string> stages;  ///< only these; none: all
  bool fpga = false;
  std::filesystem::path cache;  ///< empty: the user's
  std::string yosys = "yosys";
  int threads = 1;                                         ///< runs of yosys at a time
  std::function<void(const std::string& stage)> on_stage;  ///< before it is synthesised
};

/// Synthesises what the cache does not hold, stage by stage, and adds up. Depth is that of the whole hierarchy, counted
/// on ports as PortPaths says. Throws Error when yosys is missing or refuses, or a stage is not there.
AreaReport area_of(const AreaJob& job);

}  // namespace ctu::area
