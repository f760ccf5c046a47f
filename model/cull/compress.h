// Object masks replaced by entries of a compression LUT (paper 3.2.2 and 3.2.3).
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/compression_lut.h"
#include "model/cull/mask_weights.h"
#include "model/cull/object_masks.h"

namespace ctu::cull {

/// What a selection weighs masks with: surface areas for the paper's importance, Eq. 2's weights for ours.
ChildWeights selection_weights(const accel::Bvh4& bvh, Selection selection);

/// Every mask replaced by the tightest entry of `lut` that holds it, and its number in `index`; empty lanes are zero in
/// both.
ObjectMasks replace_masks(const accel::Bvh4& bvh, const ObjectMasks& masks, const CompressionLut& lut, int threads);

struct CompressedMasks {
  CompressionLut lut;
  ObjectMasks masks;  ///< replaced
};

/// Chooses `options.entries` entries as `options.selection` says and replaces the masks. The same for any number of
/// threads.
CompressedMasks compress(const accel::Bvh4& bvh, const ObjectMasks& masks, const MaskOptions& options, int threads);

}  // namespace ctu::cull
