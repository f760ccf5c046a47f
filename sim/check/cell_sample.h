// How many cells a design marks in a sample of lanes, beside those that the exact ray touches.
#pragma once

#include "sim/check/check_scene.h"
#include "sim/check/tally.h"

namespace ctu::sim::check {

/// Counts the box-hit lanes of one node for one ray. *Exact* are closed cells; *lost* is a half-open cell that the ray
/// touches and the design does not mark: there an object whose only occupied cell is this one would be lost. Designs
/// that read tables have one mask for a key, which mask-lut's and projection's tables hold alike; keys that are
/// uncertain mark nothing and lose nothing. Nothing is counted without culling.
void sample_cells(const CheckScene& scene, const intersect::Ray& ray, std::uint32_t node, TesterCache& testers,
                  Tally& tally);

}  // namespace ctu::sim::check
