#include "model/cull/refit_masks.h"

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/cull/mask_walk.h"

namespace ctu::cull {
namespace {

void check(const ObjectMasks& masks, const accel::Bvh4& bvh, const accel::RefitChanges& changes,
           const MaskOptions& options) {
  validate(options);
  const char* const where = "refit of object masks";
  if (!masks.index.empty())
    throw Error(where, "the masks are compressed", "refit the uncompressed masks and compress them again");
  if (masks.resolution != options.resolution)
    throw Error(where, fmt::format("the masks have R = {}, the options R = {}", masks.resolution, options.resolution),
                "give the options that the masks were built with");
  const std::size_t words = bvh.nodes.size() * intersect::kLanes * static_cast<std::size_t>(masks.words);
  if (masks.bits.size() != words || changes.nodes() != bvh.nodes.size())
    throw Error(where, fmt::format("the tree has {} nodes, the masks or the changes another number", bvh.nodes.size()),
                "give masks and changes of this tree");
}

}  // namespace

void refit_object_masks(ObjectMasks& masks, const accel::Bvh4& refitted, const accel::RefitChanges& changes,
                        const MaskOptions& options, int threads) {
  check(masks, refitted, changes, options);
  walk_masks(refitted, options.levels, &changes, masks, threads);
}

}  // namespace ctu::cull
