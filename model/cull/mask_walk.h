// The walk behind build_object_masks() and refit_object_masks().
#pragma once

#include "model/accel/bvh4.h"
#include "model/accel/refit.h"
#include "model/cull/object_masks.h"

namespace ctu::cull {

/// Makes the masks of every child, which are zero so far; or, when `changes` is given, makes anew the masks of the
/// children below which a triangle has moved. `levels` as in MaskOptions.
void walk_masks(const accel::Bvh4& bvh, int levels, const accel::RefitChanges* changes, ObjectMasks& masks,
                int threads);

}  // namespace ctu::cull
