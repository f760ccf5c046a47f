#include "model/reference/block_walk.h"

#include "model/reference/packet_walk.h"

namespace ctu::reference {

std::vector<intersect::Hit> walk_block(const Traversal& traversal, const PacketPlan& plan, RayBlock& block) {
  block.steps.clear();
  if (plan.any()) {
    const PacketWalk walk(traversal.bvh(), plan, block.rays, block.packets, block.trees);
    std::vector<intersect::Hit> hits = walk.trace(traversal, block.steps);
    block.packets = walk.list();
    return hits;
  }
  std::vector<intersect::Hit> hits;
  hits.reserve(block.rays.size());
  for (std::size_t i = 0; i < block.rays.size(); ++i)
    hits.push_back(traversal.trace_in(tree_of(block.trees, i), block.rays[i], &block.steps));
  return hits;
}

void expect_any_hits_found(std::span<const intersect::Ray> rays, std::span<const intersect::Hit> found,
                           std::span<intersect::Hit> expected) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool both_found =
        found[i].primitive != intersect::kNoPrimitive && expected[i].primitive != intersect::kNoPrimitive;
    if (rays[i].kind == intersect::RayKind::AnyHit && both_found) expected[i] = found[i];
  }
}

}  // namespace ctu::reference
