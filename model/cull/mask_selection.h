// Which masks a compression LUT holds (paper 3.2.2, and better ones).
#pragma once

#include "model/cull/compression_lut.h"
#include "model/cull/mask_weights.h"
#include "model/cull/object_masks.h"

namespace ctu::cull {

/// A LUT of at most `entries` entries, the full mask included; fewer when the tree has fewer different masks.
/// `weights`: of every child, [node*4+lane]; those of area_weights() give the paper's importance. Children without
/// weight have no say. The same for any number of threads.
CompressionLut select_masks(const ObjectMasks& masks, const ChildWeights& weights, Selection selection, int entries);

}  // namespace ctu::cull
