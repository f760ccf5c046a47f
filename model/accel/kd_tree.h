// A kd-tree over the primitives of a scene, as the software walks it. Source of the layout: pbrt (Pharr and Humphreys,
// section 4.5), which "Ray-Box Culling for Tree Structures" measures with: nodes of 8 bytes, the lower child behind its
// parent, and leaves that refer to primitives by 4 bytes each.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/accel/primitive_box.h"

namespace ctu::accel {

/// A plane between two children, or a run of references.
class KdNode {
 public:
  static KdNode leaf(std::uint32_t first, std::uint32_t references) { return {first, references << 2 | kLeaf}; }
  static KdNode inner(int axis, float plane, std::uint32_t upper_child) {
    return {std::bit_cast<std::uint32_t>(plane), upper_child << 2 | static_cast<std::uint32_t>(axis)};
  }

  bool is_leaf() const { return (tag_ & 3u) == kLeaf; }
  std::uint32_t first() const { return word_; }
  std::uint32_t references() const { return tag_ >> 2; }
  int axis() const { return static_cast<int>(tag_ & 3u); }
  float plane() const { return std::bit_cast<float>(word_); }
  std::uint32_t upper_child() const { return tag_ >> 2; }

 private:
  static constexpr std::uint32_t kLeaf = 3;
  KdNode(std::uint32_t word, std::uint32_t tag) : word_(word), tag_(tag) {}

  std::uint32_t word_, tag_;
};
static_assert(sizeof(KdNode) == 8);

/// Node 0 is the root; node n's lower child is n + 1. Cells are closed: what touches a plane is found on one side of it
/// at least, and a ray that touches the plane visits both.
struct KdTree {
  std::vector<KdNode> nodes;
  std::vector<std::uint32_t> references;  ///< ids, leaf after leaf
  std::vector<LeafTriangle> primitives;   ///< by id
  std::vector<PrimitiveBox> boxes;        ///< by id; of a clipped tree one for each reference
  bool clipped = false;
  Vec3 lower, upper;          ///< bounds of the scene
  int depth = 0;              ///< nodes on the longest path from the root
  std::uint32_t spheres = 0;  ///< how many primitives are spheres

  /// Of the reference at that place.
  const PrimitiveBox& box(std::uint32_t reference) const { return boxes[clipped ? reference : references[reference]]; }
};

/// Table 3 of the paper.
struct KdStatistics {
  std::uint64_t nodes = 0, leaves = 0, empty_leaves = 0, references = 0;
  std::uint64_t longest_leaf = 0;  ///< references
  std::uint64_t tree_bytes() const { return 8 * nodes + 4 * references; }
  std::uint64_t box_bytes = 0;
};
KdStatistics statistics(const KdTree& tree);

}  // namespace ctu::accel
