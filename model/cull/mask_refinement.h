// Entries of a compression LUT that need not be masks of the scene: a local search that lowers Eq. 2.
#pragma once

#include <cstdint>
#include <vector>

#include "model/cull/distinct_masks.h"

namespace ctu::cull {

/// Starts from the entries `start` and returns at most `entries` masks, the full one among them, that cost the weighted
/// `masks` no more than `start` does: the sum of weight times the cells that the tightest entry adds never rises.
std::vector<std::uint64_t> refine_masks(int resolution, const DistinctMasks& masks,
                                        const std::vector<std::uint64_t>& start, int entries);

}  // namespace ctu::cull
