// What of a configuration, an image and its masks decides how large a unit is and what its events move.
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/cull/on_chip_tables.h"
#include "model/pipeline/unit_config.h"

namespace ctu::energy {

struct UnitShape {
  pipeline::UnitConfig config;
  int resolution = 4, ray_resolution = 4;
  int entries = 0;                        ///< of the compression LUT; 0: masks are not compressed
  std::vector<cull::OnChipTable> tables;  ///< of the design, wherever they lie
  std::uint32_t box_bits = 32;            ///< of a coordinate of the nodes' boxes
  std::uint32_t node_bytes = 144;         ///< from a node to the next
  std::uint32_t leaf_bytes = 160;         ///< of the largest leaf
  std::uint32_t primitive_bytes = 40;     ///< from a primitive to the next
  bool primitive_boxes = false, spheres = false;
  int depth = 0;                            ///< nodes on the longest path of the tree
  bool spills = true;                       ///< some ray may need more than stack.entries
  int packet_rays = 0, packet_entries = 0;  ///< 0: rays travel alone
  int trees = 1;

  bool culls() const { return config.mask_test.design != cull::Design::None; }
  bool compares() const { return config.mask_test.design == cull::Design::Comparators; }
  /// The tables lie in memory behind table_cache.
  bool fetches_tables() const { return config.table_cache.bytes > 0 && !tables.empty(); }
  int cells() const { return resolution * resolution * resolution; }
  /// Of a lane's mask in the image: its cells, or its index.
  int mask_bits() const;
  int stack_entry_bits() const { return primitive_boxes ? 96 : 64; }
};

/// The same work in another configuration of the same design.
void set_config(UnitShape& shape, const pipeline::UnitConfig& config, const cull::MaskTester& tester);

/// The shape of the unit that runs this work.
UnitShape unit_shape(const pipeline::UnitConfig& config, const accel::Image& image, const cull::MaskTester& tester,
                     int packet_rays = 0, int packet_entries = 0);

}  // namespace ctu::energy
