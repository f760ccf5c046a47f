// What an unnecessarily set cell of a child's object mask costs: the weights of Eq. 2, and of the paper's importance.
#pragma once

#include <vector>

#include "model/accel/bvh4.h"

namespace ctu::cull {

/// C_T and C_I of Eq. 1 and Eq. 2: the cost of a visited node (one test of four boxes) and of a tested triangle. The
/// paper's unit counts both as one, and so does the builder unless it is told otherwise.
struct SahCosts {
  double node = 1, triangle = 1;
};

/// One number per lane, [node*4+lane]; 0 for empty lanes.
using ChildWeights = std::vector<double>;

/// Surface areas SA(N): importance is this times the mask's share of set cells (paper 3.2.2).
ChildWeights area_weights(const accel::Bvh4& bvh);

/// What Eq. 2 multiplies a mask's share of set cells with: C_T SA(N) for an inner child, C_I SA(N) |N| for a leaf.
ChildWeights sah_weights(const accel::Bvh4& bvh, const SahCosts& costs = {});

}  // namespace ctu::cull
