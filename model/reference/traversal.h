// Algorithm 4 of the paper: the untimed traversal with culling, the functional truth for the timed unit.
#pragma once

#include "model/accel/bvh4.h"
#include "model/cull/mask_test.h"
#include "model/intersect/ray.h"
#include "model/reference/node_test.h"
#include "model/reference/step.h"

namespace ctu::reference {

/// Traces rays one by one; const after construction, so threads share it.
class Traversal {
 public:
  /// `masks` may be null when the tester's design is none. All three must outlive this.
  Traversal(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester);

  /// The ray's hit. When `steps` is given, its event sequence is appended there as one more ray. `known`: a hit, or a
  /// miss, that is kept unless a better one is found.
  intersect::Hit trace(const intersect::Ray& ray, StepList* steps = nullptr,
                       const intersect::Hit* known = nullptr) const;

 private:
  NodeTest test_node_;
};

/// Upper bound of stack entries any ray can need in this tree: 3 for each level above the last, and 1.
int stack_bound(const accel::Bvh4& bvh);

}  // namespace ctu::reference
