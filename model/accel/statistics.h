// What a tree is like: sizes, fill and the expected cost of a ray by the surface area heuristic.
#pragma once

#include <array>
#include <cstdint>

#include "model/accel/bvh4.h"

namespace ctu::accel {

struct TreeStatistics {
  std::uint64_t nodes = 0, leaves = 0, triangles = 0;
  std::uint64_t filled_lanes = 0;                                     ///< of 4 * nodes
  int depth = 0;                                                      ///< nodes on the longest path
  std::array<std::uint64_t, kMaxLeafTriangles + 1> leaves_of_size{};  ///< by their triangles
  double sah_cost = 0;  ///< Eq. 1 of the subspace culling paper; 0 when the root has no area
};

/// Of a box that is not empty.
double surface_area(const intersect::Box4& boxes, int lane);
double surface_area(const Vec3& lower, const Vec3& upper);

/// `node_cost` and `triangle_cost` are C_T and C_I of Eq. 1; the root node counts as an inner node.
TreeStatistics statistics(const Bvh4& bvh, double node_cost = 1, double triangle_cost = 1);

/// What a ray is expected to do that visits the root, and what a box holds with some chance.
struct ExpectedWork {
  double node_visits = 1, triangle_tests = 0;
  double intersections() const { return node_visits + triangle_tests; }
};

/// `chance(lower, upper)`: of a visit to what the box holds, 0 to 1. With a box's surface area over that of the root it
/// is Eq. 1 of the subspace culling paper; with its projected area, the ray-distribution paper's.
template <class Chance>
ExpectedWork expected_work(const Bvh4& bvh, const Chance& chance) {
  ExpectedWork work;
  for (const Node4& node : bvh.nodes)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const ChildRef child = node.child[lane];
      if (child == kEmptyChild) continue;
      const auto& [lo, hi] = node.boxes;
      const double visits =
          chance(Vec3{lo[0][lane], lo[1][lane], lo[2][lane]}, Vec3{hi[0][lane], hi[1][lane], hi[2][lane]});
      (is_leaf(child) ? work.triangle_tests : work.node_visits) += visits * (is_leaf(child) ? leaf_count(child) : 1);
    }
  return work;
}

}  // namespace ctu::accel
