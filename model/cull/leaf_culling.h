// Algorithm 1 of "Ray-Box Culling for Tree Structures": a leaf's primitives, with a box test in front of each. And the
// form of it that the unit has, whose tests of a leaf's primitives are under way together: one box for the whole leaf.
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

/// Which box the primitives of a leaf are held against.
enum class RayBoxRule : std::uint8_t {
  CutAtHits,    ///< Algorithm 1: after a hit the box ends there
  OncePerLeaf,  ///< the unit's: the box from before the leaf
};

/// By RayBoxRule::OncePerLeaf: bit i is set where the box of primitive i meets the box of the ray's stay in the leaf,
/// t in [tmin, tmax]. All bits of a leaf that is tested without a box.
template <class BoxOf>
unsigned boxes_met(const intersect::Ray& ray, float tmin, float tmax, std::uint32_t count, const BoxOf& box_of) {
  if (count < kLeastCulledPrimitives) return (1u << count) - 1;
  const RayBox box(ray, tmin, tmax);
  unsigned met = 0;
  for (std::uint32_t i = 0; i < count; ++i) met |= static_cast<unsigned>(box.overlaps(box_of(i))) << i;
  return met;
}

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
