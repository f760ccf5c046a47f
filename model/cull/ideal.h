// Ideal culling: the cells a ray meets, by grid traversal (Amanatides and Woo 1987), in double precision with ties
// and rounding resolved towards marking a cell. The bound that tables are measured against (paper 4.1).
#pragma once

#include <cstdint>

#include "model/intersect/slab_test.h"

namespace ctu::cull {

void ideal_mask(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
                int lane, int resolution, std::uint64_t* words);

}  // namespace ctu::cull
