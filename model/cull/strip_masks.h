// Masks that do not pay are made full: full masks pass unasked, so their lanes take no look-up, and a node whose lanes
// are all full needs no masks in the image.
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/compression_lut.h"
#include "model/cull/object_masks.h"

namespace ctu::cull {

/// `masks` with full ones (in a compressed set the last entry of `lut`) in every child whose bit lane is not set in
/// `kept[node]`. Conservative whatever is kept. Throws Error when `kept` is of another tree.
ObjectMasks strip_masks(const accel::Bvh4& bvh, const ObjectMasks& masks, const CompressionLut* lut,
                        const std::vector<std::uint8_t>& kept);

/// Nodes with a child whose mask is not full: the nodes that need masks.
std::uint64_t nodes_with_masks(const accel::Bvh4& bvh, const ObjectMasks& masks);

}  // namespace ctu::cull
