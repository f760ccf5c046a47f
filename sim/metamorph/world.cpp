#include "sim/metamorph/world.h"

#include <algorithm>
#include <utility>

namespace ctu::sim::metamorph {

using cull::Design;

namespace {

cull::MaskOptions without_entries(cull::MaskOptions options) {
  options.entries = 0;
  return options;
}

}  // namespace

World::World(accel::Bvh4 bvh, const WorldOptions& options) : bvh_(std::move(bvh)) {
  plain_ = traces::make_masks(bvh_, without_entries(options.masks), options.threads);
  const auto& designs = options.designs;
  const bool compressed = std::find(designs.begin(), designs.end(), Design::BitTable) != designs.end();
  if (compressed) compressed_ = traces::mask_set(bvh_, plain_.masks, options.masks, options.threads);
  add_designs(options, compressed);
}

World::World(accel::Bvh4 bvh, cull::ObjectMasks masks, const WorldOptions& options) : bvh_(std::move(bvh)) {
  plain_.masks = std::move(masks);
  add_designs(options, false);
}

void World::add_designs(const WorldOptions& options, bool compressed) {
  const cull::MaskOptions plain_options = without_entries(options.masks);
  add(Design::None, plain_, plain_options);
  for (const Design design : options.designs) {
    if (design == Design::None) continue;
    if (design != Design::BitTable)
      add(design, plain_, plain_options);
    else if (compressed)
      add(design, compressed_, options.masks);
  }
}

void World::add(Design design, const traces::MaskSet& set, const cull::MaskOptions& options) {
  testers_.push_back(std::make_unique<cull::MaskTester>(design, options, set.lut));
  traversals_.emplace_back(bvh_, &set.masks, *testers_.back());
}

}  // namespace ctu::sim::metamorph
