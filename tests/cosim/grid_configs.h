// The configurations of the co-simulation grid.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/pipeline/unit_config.h"
#include "model/reference/packet_list.h"
#include "sim/cosim/rtl_unit.h"

namespace ctu::cosim {

struct GridConfig {
  std::string build;             ///< of sim/cosim/builds.cmake
  std::string settings;          ///< "key=value key=value ..."; what the build fixes is added by itself
  std::uint64_t stall_seed = 0;  ///< not 0: every link refuses at random
  bool quick = false;            ///< part of the share that the test suite runs
  reference::PacketPlan packets{};
  int trees = 1;  ///< of the image; each ray, or packet, walks one of them
};

const std::vector<GridConfig>& grid_configs();

/// The unit's configuration: what the build fixes, then the settings. Throws Error on a setting that is none.
pipeline::UnitConfig unit_config(const RtlParameters& build, const std::string& settings);

/// The masks that the build is for.
cull::MaskOptions mask_options(const RtlParameters& build);

}  // namespace ctu::cosim
