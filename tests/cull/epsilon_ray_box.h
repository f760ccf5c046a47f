// Algorithms 2 and 4 as the paper prints them, in plain binary32 with its fixed epsilon: for comparison only.
#pragma once

#include "model/accel/kd_tree.h"
#include "model/intersect/ray.h"

namespace ctu::test {

class EpsilonRayBox {
 public:
  EpsilonRayBox(const intersect::Ray& ray, float tmin, float tmax) {
    for (int axis = 0; axis < 3; ++axis) {
      const float from = ray.origin[axis] + tmin * ray.direction[axis],
                  to = ray.origin[axis] + tmax * ray.direction[axis];
      const bool forwards = ray.direction[axis] >= 0;
      box_.lower[axis] = (forwards ? from : to) - kEpsilon;
      box_.upper[axis] = (forwards ? to : from) + kEpsilon;
    }
  }
  void end_at(const intersect::Ray& ray, float tmax) {
    for (int axis = 0; axis < 3; ++axis) {
      const float hit = ray.origin[axis] + tmax * ray.direction[axis];
      if (ray.direction[axis] >= 0)
        box_.upper[axis] = hit + kEpsilon;
      else
        box_.lower[axis] = hit - kEpsilon;
    }
  }
  bool overlaps(const accel::PrimitiveBox& other) const {
    for (int axis = 0; axis < 3; ++axis)
      if (box_.lower[axis] > other.upper[axis] || box_.upper[axis] < other.lower[axis]) return false;
    return true;
  }

 private:
  static constexpr float kEpsilon = 0.0001f;
  accel::PrimitiveBox box_;
};

}  // namespace ctu::test
