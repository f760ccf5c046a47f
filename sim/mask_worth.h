// Which object masks pay. A mask is worth what the walk below it would have cost the rays that it culls, less the
// look-ups of all rays that ask it; a node's masks together must also be worth the bytes that they add to every visit.
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "sim/ray_sample.h"

namespace ctu::sim {

/// What a ray pays for what it visits, in cycles of its stay in the unit.
struct VisitCosts {
  double node = 0;        ///< a visit of a node without masks
  double mask_bytes = 0;  ///< ... and what it costs more when the node carries masks
  double look_up = 0;     ///< a lane whose mask is asked
  double leaf = 0, triangle = 0;
};

/// Of every node, the lanes (bits) whose masks pay for the rays of `sample`. Nodes that few of these rays visit are
/// judged by what masks like theirs are worth elsewhere in the tree: as full, above as many triangles. The same for any
/// number of threads.
std::vector<std::uint8_t> lanes_that_pay(const accel::Bvh4& bvh, const cull::ObjectMasks& masks,
                                         const cull::MaskTester& tester, const RaySample& sample,
                                         const VisitCosts& costs, int threads);

}  // namespace ctu::sim
