// The parameters of rtl/ctu_unit.sv that make it the unit of a configuration, no larger than it needs.
#pragma once

#include <filesystem>

#include "model/cull/options.h"
#include "model/pipeline/unit_config.h"
#include "sim/area/yosys.h"

namespace ctu::area {

/// What image and rays have that stages are there for, or are wider for.
struct ImageParts {
  std::uint32_t box_bits = 32;  ///< of a coordinate of the nodes' boxes
  bool primitive_boxes = false, spheres = false;
  int packet_entries = 0;  ///< of a packet at most; 0: rays travel alone
  int trees = 1;
};

/// Of masks count R, R_ray and the number of entries. Leaves have four primitives at most. Both caches have the sets,
/// ways and miss registers of the larger one, as one parameter says it for both. The stack can spill. `top` is the
/// source of the unit. Throws Error when the RTL does not have what the configuration asks for.
RtlParameters unit_parameters(const pipeline::UnitConfig& config, const cull::MaskOptions& masks,
                              const std::filesystem::path& top, const ImageParts& image = {});

}  // namespace ctu::area
