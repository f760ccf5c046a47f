// How a range of triangles is cut in two: binned SAH (Wald 2007), an exact sweep for a few triangles,
// and the median where the SAH cannot go on.
#pragma once

#include <cstddef>
#include <span>

#include "model/accel/triangle_ref.h"

namespace ctu::accel {

inline constexpr int kMaxBins = 64;

/// Reorders `refs` and returns how many go to the left: 1 .. size-1. `refs` has at least two. The order that
/// results depends on the order given and on nothing else.
std::size_t split_sah(std::span<TriangleRef> refs, int bins);

/// Halves `refs` (left: the smaller half) at the median centre of the widest axis, ties by id.
std::size_t split_median(std::span<TriangleRef> refs);

}  // namespace ctu::accel
