// The local trees that a trace is recorded with: influence areas are found from its own shadow rays, each gets a tree,
// and a ray that certainly has its whole answer there walks that tree instead of the one over the whole scene.
#pragma once

#include <vector>

#include "model/influence/tree_set.h"
#include "model/reference/ray_tree.h"
#include "model/reference/traversal.h"
#include "model/reference/tree_choice.h"
#include "traces/ray_generator.h"
#include "traces/ray_trees.h"

namespace ctu::traces {

class LocalTrees {
 public:
  /// Of the shadow rays that `generator` makes, evenly spread ones are looked at; `global` is the tree over all of the
  /// scene. A tree that does not save these rays tests is left out. There may be no area, and then no tree: rays that
  /// are no shadow rays are in none.
  LocalTrees(const scene::Scene& scene, const RayGenerator& generator, const accel::Bvh4& global,
             const RayTrees& options, const accel::BuildOptions& build);
  LocalTrees(const LocalTrees&) = delete;
  LocalTrees& operator=(const LocalTrees&) = delete;

  std::uint32_t count() const { return static_cast<std::uint32_t>(kept_.size()); }
  const accel::Bvh4& tree(std::uint32_t i) const { return trees_.local(kept_[i]); }

  /// The trees of rays, 0 or 1 + a local one, and their tests there; `traversal` is without culling, of global and
  /// local trees in one.
  std::vector<reference::RayTree> choose(const reference::Traversal& traversal,
                                         const std::vector<intersect::Ray>& rays) const;

 private:
  LocalTrees(const scene::Scene& scene, const std::vector<intersect::Ray>& shadow, const accel::Bvh4& global,
             const RayTrees& options, const accel::BuildOptions& build);
  /// Areas whose trees save `shadow` tests.
  std::vector<std::uint32_t> worth_keeping(const std::vector<intersect::Ray>& shadow) const;

  influence::TreeSet trees_;
  reference::TreeChoice choice_;
  std::vector<std::uint32_t> kept_;  ///< areas, ascending
};

/// Puts the rays of each window that walk one tree one behind the other, else in the order they are in: their places
/// in `order` change within windows.
void put_trees_together(const std::vector<reference::RayTree>& trees, int window, std::vector<std::uint32_t>& order);

}  // namespace ctu::traces
