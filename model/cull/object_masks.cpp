#include "model/cull/object_masks.h"

#include "model/cull/mask_walk.h"

namespace ctu::cull {

ObjectMasks build_object_masks(const accel::Bvh4& bvh, const MaskOptions& options, int threads) {
  validate_object_masks(options);
  ObjectMasks masks;
  masks.resolution = options.resolution;
  masks.words = words_per_mask(options.resolution);
  masks.bits.resize(bvh.nodes.size() * intersect::kLanes * static_cast<std::size_t>(masks.words));
  walk_masks(bvh, options.levels, nullptr, masks, threads);
  return masks;
}

}  // namespace ctu::cull
