// In which order a ray visits the children of a node that pass its tests.
#pragma once

#include <cstdint>

#include "model/intersect/slab_test.h"

namespace ctu::reference {

/// The survivors' lanes, nearest first; equal distances in lane order.
struct VisitOrder {
  int count = 0;
  std::uint8_t lane[intersect::kLanes] = {};
};

inline VisitOrder sort_survivors(unsigned survivors, const float* t0) {
  VisitOrder order;
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    if (((survivors >> lane) & 1u) == 0) continue;
    int position = order.count++;
    for (; position > 0 && t0[lane] < t0[order.lane[position - 1]]; --position)
      order.lane[position] = order.lane[position - 1];
    order.lane[position] = static_cast<std::uint8_t>(lane);
  }
  return order;
}

}  // namespace ctu::reference
