// A tree and its object masks carried along when axes are permuted or mirrored: the same nodes over moved boxes, the
// same cells by other numbers. What is built anew may differ: equal costs are decided by the order of the axes and bins
// are half-open, so a builder's ties break the symmetry; what is carried along may not.
#pragma once

#include "model/accel/bvh4.h"
#include "model/cull/object_masks.h"
#include "sim/metamorph/transformation.h"

namespace ctu::sim::metamorph {

/// The transformation must be exact; boxes are transformed as their corners are.
accel::Bvh4 carried(const accel::Bvh4& bvh, const Transformation& transformation);

/// The masks must not be compressed.
cull::ObjectMasks carried(const cull::ObjectMasks& masks, const Transformation& transformation);

/// Whether two trees are the same, bit for bit.
bool same_tree(const accel::Bvh4& a, const accel::Bvh4& b);

}  // namespace ctu::sim::metamorph
