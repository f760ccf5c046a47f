// `comparators`: the touched cells without a table, from the inner planes' times (DESIGN section 4).
#pragma once

#include <cstdint>

#include "model/intersect/slab_test.h"

namespace ctu::cull {

/// Sets the bit of every cell that the ray may touch within [t0, t1] of a lane the slab test hit; a superset of the
/// closed cells touched in exact arithmetic. `words` has words_per_mask(resolution) entries.
void comparator_mask(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
                     int lane, int resolution, std::uint64_t* words);

}  // namespace ctu::cull
