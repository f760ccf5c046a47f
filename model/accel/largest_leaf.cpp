#include "model/accel/largest_leaf.h"

#include <algorithm>

#include "model/accel/child_ref.h"

namespace ctu::accel {

std::uint32_t largest_leaf_bytes(const Image& image) {
  int primitives = 0;
  for (std::uint32_t n = 0; n < image.node_count; ++n)
    for (const ChildRef child : read_node(image, n).child)
      if (is_leaf(child)) primitives = std::max(primitives, static_cast<int>(leaf_count(child)));
  return static_cast<std::uint32_t>(primitives) * image.triangle_stride_bytes;
}

}  // namespace ctu::accel
