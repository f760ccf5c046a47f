#include "model/accel/partition.h"

#include <algorithm>
#include <numeric>

namespace ctu::accel {

Partition partition_nodes(Bvh4& bvh, const std::vector<bool>& carries_masks) {
  std::vector<bool> stays_first = carries_masks;
  for (std::uint32_t tree = 0; tree < bvh.trees(); ++tree) stays_first[bvh.root(tree)] = true;
  Partition partition;
  partition.old_index.resize(bvh.nodes.size());
  std::iota(partition.old_index.begin(), partition.old_index.end(), 0u);
  const auto bare = std::stable_partition(partition.old_index.begin(), partition.old_index.end(),
                                          [&](std::uint32_t node) { return stays_first[node]; });
  partition.bare_nodes = static_cast<std::uint32_t>(partition.old_index.end() - bare);

  std::vector<std::uint32_t> new_index(bvh.nodes.size());
  std::vector<Node4> nodes;
  nodes.reserve(bvh.nodes.size());
  for (const std::uint32_t old : partition.old_index) {
    new_index[old] = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back(bvh.nodes[old]);
  }
  for (Node4& node : nodes)
    for (ChildRef& child : node.child)
      if (is_inner(child)) child = new_index[child];
  for (ChildRef& root : bvh.further_roots) root = new_index[root];
  bvh.nodes = std::move(nodes);
  return partition;
}

}  // namespace ctu::accel
