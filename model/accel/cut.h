// A way to cut a range of triangles in two, and what a builder expects it to cost.
#pragma once

#include <cstddef>
#include <limits>

namespace ctu::accel {

struct Cut {
  float cost = std::numeric_limits<float>::infinity();  ///< sum over the children: chance of a visit times triangles
  float children = 0;                                   ///< sum over the children: chance of a visit
  std::size_t imbalance = 0;                            ///< by how many triangles the children differ
  int axis = -1;                                        ///< -1: there is no cut
  int position = 0;                                     ///< bins, or triangles in order, that go to the left

  /// Takes `other` if it is better. Among equal costs the most even one is, so that equal boxes give an even tree.
  void offer(const Cut& other) {
    if (other.axis < 0) return;
    if (axis >= 0 && !(other.cost < cost || (other.cost == cost && other.imbalance < imbalance))) return;
    *this = other;
  }
};

/// The cut into `left` and `right` triangles, whose boxes have these chances.
inline Cut make_cut(float left_chance, std::size_t left, float right_chance, std::size_t right, int axis,
                    int position) {
  return {left_chance * static_cast<float>(left) + right_chance * static_cast<float>(right), left_chance + right_chance,
          left < right ? right - left : left - right, axis, position};
}

}  // namespace ctu::accel
