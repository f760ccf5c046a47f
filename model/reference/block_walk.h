// The rays of a block on their ways: each in its tree, alone or from where its packet has left it.
#pragma once

#include <span>
#include <vector>

#include "model/reference/ray_block.h"
#include "model/reference/traversal.h"

namespace ctu::reference {

/// What the rays of the block find, by ray. Its steps become those of this walk, and so does what its packets, which
/// must be cut where `plan` has any, visit.
std::vector<intersect::Hit> walk_block(const Traversal& traversal, const PacketPlan& plan, RayBlock& block);

/// Any hit answers an any-hit ray, and in a tree of its own or from its packet's entries it may come to another one
/// first than alone in the tree over the whole scene. Where both find one, what it finds on its way (`found`) is what
/// it is expected to find.
void expect_any_hits_found(std::span<const intersect::Ray> rays, std::span<const intersect::Hit> found,
                           std::span<intersect::Hit> expected);

}  // namespace ctu::reference
