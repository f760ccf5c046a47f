// Object masks for moved vertices.
#pragma once

#include "model/accel/refit.h"
#include "model/cull/object_masks.h"

namespace ctu::cull {

/// Brings `masks`, made with `options` before the refit, to what build_object_masks() makes of the refitted tree, bit
/// for bit. A mask depends on its box and on the triangles below (with limited L by way of the boxes and masks L
/// levels below), so only those of children below which a triangle has moved are made anew; the boxes above them all
/// are such children. The same for any number of threads.
///
/// Throws ctu::Error, before anything is changed, when the masks are compressed (refit the uncompressed ones and
/// compress them again), or when the masks, the options or the changes belong to another tree.
void refit_object_masks(ObjectMasks& masks, const accel::Bvh4& refitted, const accel::RefitChanges& changes,
                        const MaskOptions& options, int threads);

}  // namespace ctu::cull
