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

}  // namespace ctu::accel
