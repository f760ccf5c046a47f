// Eq. 2 of the paper: the surface area heuristic of a tree whose children have object masks.
#pragma once

#include "model/accel/bvh4.h"
#include "model/cull/mask_weights.h"
#include "model/cull/object_masks.h"

namespace ctu::cull {

/// SAH_masked: Eq. 1 (accel::statistics) with every child's area scaled by the share of cells its mask has set, on the
/// assumption that this is the share of the box's rays that pass. The root has no mask and counts in full, so that
/// full masks give Eq. 1. 0 when the root has no area.
double sah_masked(const accel::Bvh4& bvh, const ObjectMasks& masks, const SahCosts& costs = {});

}  // namespace ctu::cull
