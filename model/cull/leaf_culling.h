// Algorithm 1 of "Ray-Box Culling for Tree Structures": a leaf's primitives, with a box test in front of each.
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "model/cull/ray_box.h"

namespace ctu::cull {

/// Leaves of fewer primitives are tested without a box. The paper's text calls 2 "the minimum number of primitives to
/// enable" culling, but its algorithm asks for n > PRIM_NUM and sets PRIM_NUM to 2. Its Table 2 was measured with the
/// former: with it our boxes per ray on the Balls are the table's, with the latter about half as many or fewer.
inline constexpr std::uint32_t kLeastCulledPrimitives = 2;

/// Tests the primitives 0 .. count-1 of a leaf that the ray stays in for t in [tmin, tmax] at most. `box_of(i)` is the
/// box of primitive i; `test(i)` tests it and says whether it became the best hit, which is then at `best_t`; `any_hit`
/// ends the leaf there. `Box` is RayBox, NoRayBox, or another class with RayBox's operations.
template <class Box, class BoxOf, class Test>
void visit_leaf(const intersect::Ray& ray, float tmin, float tmax, std::uint32_t count, const float& best_t,
                bool any_hit, const BoxOf& box_of, const Test& test, RayBoxCounts& counts) {
  if constexpr (!std::is_same_v<Box, NoRayBox>) {
    if (count >= kLeastCulledPrimitives) {
      Box box(ray, tmin, std::min(tmax, best_t));
      ++counts.created;
      for (std::uint32_t i = 0; i < count; ++i) {
        ++counts.box_tests;
        if (!box.overlaps(box_of(i))) continue;
        ++counts.primitive_tests;
        if (!test(i)) continue;
        if (any_hit) return;
        if (i + 1 == count) return;
        box.end_at(ray, std::min(tmax, best_t));
        ++counts.updated;
      }
      return;
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    ++counts.primitive_tests;
    if (test(i) && any_hit) return;
  }
}

}  // namespace ctu::cull
