// A tree for moved vertices: the same nodes and leaves, boxes made anew from the leaves up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/scene/scene.h"

namespace ctu::accel {

/// Which children a refit changed, to the bit. A child whose box has changed has moved triangles below it; a child
/// with moved triangles below it is below such children only.
class RefitChanges {
 public:
  explicit RefitChanges(std::size_t nodes) : moved_(nodes), boxes_(nodes) {}

  /// Whether a triangle below the child has moved.
  bool moved(std::uint32_t node, int lane) const { return (moved_[node] >> lane & 1) != 0; }
  /// Whether the child's box is another one.
  bool box(std::uint32_t node, int lane) const { return (boxes_[node] >> lane & 1) != 0; }
  /// Whether a triangle below the node has moved.
  bool any(std::uint32_t node) const { return moved_[node] != 0; }
  std::size_t nodes() const { return moved_.size(); }

  void set(std::uint32_t node, int lane, bool box_changed) {
    moved_[node] = static_cast<std::uint8_t>(moved_[node] | 1u << lane);
    if (box_changed) boxes_[node] = static_cast<std::uint8_t>(boxes_[node] | 1u << lane);
  }

 private:
  std::vector<std::uint8_t> moved_, boxes_;  ///< [node], bit lane
};

/// Gives every leaf triangle the vertices that its primitive has in `moved`, then every box and the scene's bounds what
/// build() would have given this tree; vertices that have not moved leave it as it is, to the bit. The tree keeps its
/// topology, which gets looser the further the vertices move from where they were when it was built. The same for any
/// number of threads.
///
/// Throws ctu::Error, before anything is changed, when `moved` has another number of triangles than the tree, or when a
/// corner is missing or not finite.
RefitChanges refit(Bvh4& bvh, const scene::Mesh& moved, int threads);

}  // namespace ctu::accel
