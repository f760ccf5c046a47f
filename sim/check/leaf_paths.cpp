#include "sim/check/leaf_paths.h"

#include <bit>

namespace ctu::sim::check {

LeafPaths::LeafPaths(const accel::Bvh4& bvh) : leaf_of_(bvh.triangles.size()), parent_of_(bvh.nodes.size()) {
  for (std::uint32_t node = 0; node < bvh.nodes.size(); ++node)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const accel::ChildRef child = bvh.nodes[node].child[lane];
      if (accel::is_inner(child)) parent_of_[child] = {node, lane};
      if (!accel::is_leaf(child)) continue;
      for (int i = 0; i < accel::leaf_count(child); ++i)
        leaf_of_[accel::leaf_first(child) + static_cast<std::uint32_t>(i)] = {node, lane};
    }
}

PathCheck::PathCheck(const reference::NodeTest& test_node)
    : test_node_(test_node),
      paths_(test_node.bvh()),
      tested_in_(test_node.bvh().nodes.size(), 0),
      passed_(test_node.bvh().nodes.size(), 0) {}

void PathCheck::start(const intersect::PreparedRay& ray) {
  ray_ = ray;
  ++turn_;
}

unsigned PathCheck::passed(std::uint32_t node) {
  if (tested_in_[node] == turn_) return passed_[node];
  intersect::SlabTimes times;
  const cull::MaskTestResult outcome = test_node_(ray_, node, ray_.ray.tmax, times);
  lanes_ += static_cast<std::uint64_t>(std::popcount(times.hit));
  uncertain_ += static_cast<std::uint64_t>(std::popcount(outcome.uncertain));
  tested_in_[node] = turn_;
  return passed_[node] = outcome.pass;
}

bool PathCheck::reaches(std::uint32_t triangle, LaneRef& rejected) {
  LaneRef at = paths_.leaf_of(triangle);
  for (;;) {
    if ((passed(at.node) >> at.lane & 1u) == 0) {
      rejected = at;
      return false;
    }
    if (at.node == 0) return true;
    at = paths_.parent_of(at.node);
  }
}

void PathCheck::add_lanes(Tally& tally) const {
  tally.lanes += lanes_;
  tally.uncertain_lanes += uncertain_;
}

}  // namespace ctu::sim::check
