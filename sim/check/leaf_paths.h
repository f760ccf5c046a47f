// The way from the root to each triangle's leaf, and which steps of it a ray's first interval survives: contract 1 as
// it is written, independent of the triangle test and of what the traversal finds on its way.
#pragma once

#include <cstdint>
#include <vector>

#include "model/reference/node_test.h"
#include "sim/check/tally.h"

namespace ctu::sim::check {

/// A lane of a node.
struct LaneRef {
  std::uint32_t node = 0;
  int lane = 0;
};

class LeafPaths {
 public:
  explicit LeafPaths(const accel::Bvh4& bvh);
  /// The lane whose child is the leaf that holds the triangle.
  LaneRef leaf_of(std::uint32_t triangle) const { return leaf_of_[triangle]; }
  /// The lane whose child is the node; the root has none.
  LaneRef parent_of(std::uint32_t node) const { return parent_of_[node]; }

 private:
  std::vector<LaneRef> leaf_of_, parent_of_;
};

/// One ray's outcome at the nodes it is asked at, each tested once, with the ray's own [tmin, tmax].
class PathCheck {
 public:
  explicit PathCheck(const reference::NodeTest& test_node);

  void start(const intersect::PreparedRay& ray);
  /// Whether every lane on the way to the triangle's leaf is hit and passed. Otherwise `rejected` is the first, from
  /// the leaf up, that is not.
  bool reaches(std::uint32_t triangle, LaneRef& rejected);

  /// Lanes hit and lanes passed as uncertain, of all tests so far.
  void add_lanes(Tally& tally) const;

 private:
  unsigned passed(std::uint32_t node);

  reference::NodeTest test_node_;
  LeafPaths paths_;
  intersect::PreparedRay ray_;
  std::uint32_t turn_ = 0;
  std::vector<std::uint32_t> tested_in_;  ///< by node: the ray it was tested for last
  std::vector<std::uint8_t> passed_;
  std::uint64_t lanes_ = 0, uncertain_ = 0;
};

}  // namespace ctu::sim::check
