// A tree with the masks and tables of several mask-test designs over it, ready to be asked.
#pragma once

#include <memory>
#include <vector>

#include "model/accel/build.h"
#include "model/cull/mask_test.h"
#include "model/reference/traversal.h"
#include "traces/mask_set.h"

namespace ctu::sim::metamorph {

struct WorldOptions {
  accel::BuildOptions build;
  cull::MaskOptions masks;            ///< `entries` are those of bit-table; the others' masks are not compressed
  std::vector<cull::Design> designs;  ///< None comes before them, whether listed or not
  int threads = 1;
};

class World {
 public:
  /// Makes the masks of the tree.
  World(accel::Bvh4 bvh, const WorldOptions& options);
  /// With masks that are there. Designs that need compressed ones are left out.
  World(accel::Bvh4 bvh, cull::ObjectMasks masks, const WorldOptions& options);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const accel::Bvh4& bvh() const { return bvh_; }
  const cull::ObjectMasks& masks() const { return plain_.masks; }
  const cull::ObjectMasks& compressed_masks() const { return compressed_.masks; }  ///< empty when no design needs them

  std::size_t designs() const { return traversals_.size(); }
  cull::Design design(std::size_t i) const { return testers_[i]->design(); }  ///< the first is None
  const reference::Traversal& traversal(std::size_t i) const { return traversals_[i]; }

 private:
  void add(cull::Design design, const traces::MaskSet& set, const cull::MaskOptions& options);
  void add_designs(const WorldOptions& options, bool compressed);

  accel::Bvh4 bvh_;
  traces::MaskSet plain_, compressed_;
  std::vector<std::unique_ptr<cull::MaskTester>> testers_;
  std::vector<reference::Traversal> traversals_;
};

}  // namespace ctu::sim::metamorph
