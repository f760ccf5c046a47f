// A weighted sample of a tree's masks, small enough to search over and large enough to stand for all of them.
#pragma once

#include <cstddef>
#include <vector>

#include "model/cull/distinct_masks.h"

namespace ctu::cull {

/// At least `enough` different masks, or all there are, with the weight of the children they stand for. A child is
/// drawn by what compression can cost it at most: its weight times the cells its mask has not set; full masks are left
/// out. Systematic sampling: no random numbers, and a child that weighs more than a step of the sample is always there.
DistinctMasks sample_masks(const ObjectMasks& masks, const std::vector<double>& weights, std::size_t enough);

}  // namespace ctu::cull
