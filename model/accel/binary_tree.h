// The binary tree under the 4-wide one, down to single triangles. A subtree over n triangles has exactly 2n-1 nodes,
// so every node's place is known before it is made: left child at node + 1, right child at node + 2 * left triangles.
// That is why any number of threads builds the same tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/accel/triangle_ref.h"

namespace ctu::accel {

struct BinaryNode {
  float half_area;          ///< of the box of its triangles
  std::uint32_t triangles;  ///< below it: a run of the reordered refs
  std::uint32_t left;       ///< of them, in the left child; 0 in a leaf (one triangle)
};

constexpr std::uint32_t left_child(std::uint32_t node) { return node + 1; }
constexpr std::uint32_t right_child(std::uint32_t node, std::uint32_t left) { return node + 2 * left; }

/// Reorders `refs` (at least one) into leaf order. No path has more than 2 * ceil(log2(refs)) + 8 edges.
std::vector<BinaryNode> build_binary_tree(std::span<TriangleRef> refs, int bins, int threads);

}  // namespace ctu::accel
