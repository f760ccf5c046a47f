// Orders the nodes of a tree so that those which carry masks come first: image.h lays the others out without.
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"

namespace ctu::accel {

struct Partition {
  std::vector<std::uint32_t> old_index;  ///< of each node in its new place
  std::uint32_t bare_nodes = 0;          ///< the last ones
};

/// Puts the nodes for which `carries_masks` is true, and the roots, before the others, each part in its old order, and
/// renames children. A child may then come before its parent. Leaves and triangles stay as they are.
Partition partition_nodes(Bvh4& bvh, const std::vector<bool>& carries_masks);

}  // namespace ctu::accel
