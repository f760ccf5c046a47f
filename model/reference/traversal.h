// Algorithm 4 of the paper: the untimed traversal with culling, the functional truth for the timed unit.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/accel/primitive_box.h"
#include "model/cull/leaf_culling.h"
#include "model/cull/mask_test.h"
#include "model/intersect/ray.h"
#include "model/reference/entry_list.h"
#include "model/reference/node_test.h"
#include "model/reference/step.h"

namespace ctu::reference {

/// Traces rays one by one; const after construction, so threads share it.
class Traversal {
 public:
  /// `masks` may be null when the tester's design is none. With `leaf_boxes`, those of leaf_boxes(bvh), ray boxes cull
  /// primitives in the leaves by `rule`; a step then counts the primitives that were tested, and by
  /// RayBoxRule::OncePerLeaf StepList::met says which. All must outlive this.
  Traversal(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester,
            const std::vector<accel::PrimitiveBox>* leaf_boxes = nullptr,
            cull::RayBoxRule rule = cull::RayBoxRule::CutAtHits);

  const accel::Bvh4& bvh() const { return test_node_.bvh(); }

  /// The ray's hit. When `steps` is given, its event sequence is appended there as one more ray. `known`: a hit, or a
  /// miss, that is kept unless a better one is found. What ray boxes did, if they cull, is added to `box_counts`.
  intersect::Hit trace(const intersect::Ray& ray, StepList* steps = nullptr, const intersect::Hit* known = nullptr,
                       cull::RayBoxCounts* box_counts = nullptr) const;

  /// The ray's hit in one of several trees (accel/forest.h), and its event sequence when `steps` is given.
  intersect::Hit trace_in(std::uint32_t tree, const intersect::Ray& ray, StepList* steps = nullptr) const;

  /// The hit of a ray that goes on alone where its packet has left it, and its event sequence.
  intersect::Hit trace_from(const EntryList& entries, const intersect::Ray& ray, StepList& steps) const;

 private:
  NodeTest test_node_;
  const std::vector<accel::PrimitiveBox>* leaf_boxes_;
  cull::RayBoxRule rule_;
};

/// The boxes of the primitives in leaf order, for ray-box culling.
std::vector<accel::PrimitiveBox> leaf_boxes(const accel::Bvh4& bvh);

/// No ray may ever hold more: Step::dropped counts in 8 bits.
inline constexpr int kMaxStackEntries = std::numeric_limits<std::uint8_t>::max();

/// Upper bound of stack entries any ray can need in this tree: 3 for each level above the last, and 1.
int stack_bound(const accel::Bvh4& bvh);

}  // namespace ctu::reference
