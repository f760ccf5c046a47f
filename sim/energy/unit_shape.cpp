#include "sim/energy/unit_shape.h"

#include <bit>

#include "model/accel/largest_leaf.h"

namespace ctu::energy {

int UnitShape::mask_bits() const {
  if (!culls()) return 0;
  return entries > 0 ? std::max(1, static_cast<int>(std::bit_width(static_cast<unsigned>(entries - 1)))) : cells();
}

void set_config(UnitShape& shape, const pipeline::UnitConfig& config, const cull::MaskTester& tester) {
  shape.config = config;
  shape.tables.clear();
  if (shape.culls())
    shape.tables = cull::OnChipTables(tester, config.mask_test.rows, config.mask_test.projection_tables).tables();
  shape.spills = 3 * shape.depth + shape.packet_entries > config.stack.entries;
}

UnitShape unit_shape(const pipeline::UnitConfig& config, const accel::Image& image, const cull::MaskTester& tester,
                     int packet_rays, int packet_entries) {
  UnitShape shape;
  shape.resolution = tester.options().resolution;
  shape.ray_resolution = tester.options().ray_resolution;
  shape.entries = tester.options().entries;
  shape.box_bits = image.layout.box_bits;
  shape.node_bytes = image.node_stride_bytes;
  shape.primitive_bytes = image.triangle_stride_bytes;
  shape.leaf_bytes = accel::largest_leaf_bytes(image);
  shape.primitive_boxes = image.layout.primitive_boxes;
  shape.spheres = image.sphere_count != 0;
  shape.packet_rays = packet_rays;
  shape.packet_entries = packet_rays > 0 ? packet_entries : 0;
  shape.depth = image.depth;
  shape.trees = static_cast<int>(image.trees());
  set_config(shape, config, tester);
  return shape;
}

}  // namespace ctu::energy
