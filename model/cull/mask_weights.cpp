#include "model/cull/mask_weights.h"

#include "model/accel/statistics.h"

namespace ctu::cull {
namespace {

/// `cost(child)`: of the surface area of a child.
template <class Cost>
ChildWeights weigh(const accel::Bvh4& bvh, Cost&& cost) {
  ChildWeights weights(bvh.nodes.size() * intersect::kLanes);
  auto weight = weights.begin();
  for (const accel::Node4& node : bvh.nodes)
    for (int lane = 0; lane < intersect::kLanes; ++lane, ++weight)
      if (node.child[lane] != accel::kEmptyChild)
        *weight = accel::surface_area(node.boxes, lane) * cost(node.child[lane]);
  return weights;
}

}  // namespace

ChildWeights area_weights(const accel::Bvh4& bvh) {
  return weigh(bvh, [](accel::ChildRef) { return 1.0; });
}

ChildWeights sah_weights(const accel::Bvh4& bvh, const SahCosts& costs) {
  return weigh(bvh, [&](accel::ChildRef child) {
    return accel::is_leaf(child) ? costs.triangle * accel::leaf_count(child) : costs.node;
  });
}

}  // namespace ctu::cull
