#include "model/reference/traversal.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/intersect/triangle_test.h"
#include "model/reference/visit_order.h"

namespace ctu::reference {
namespace {

using intersect::kLanes;

struct StackEntry {
  accel::ChildRef ref;
  float t0;
};

// Step::dropped counts in 8 bits, so no ray may ever hold more entries than that.
constexpr int kMaxStackEntries = std::numeric_limits<std::uint8_t>::max();

/// One ray on its way through the tree. `kRecord` decides once whether the event sequence is written.
template <bool kRecord>
class Walk {
 public:
  Walk(const NodeTest& test_node, const intersect::Ray& ray, StepList* steps, const intersect::Hit* known)
      : test_node_(test_node),
        bvh_(test_node.bvh()),
        ray_(intersect::prepare_ray(ray)),
        steps_(steps),
        keyed_(cull::reads_tables(test_node.tester().design())) {
    best_ = known != nullptr ? *known : intersect::Hit{ray.tmax, 0, 0, intersect::kNoPrimitive};
  }

  intersect::Hit run() {
    if (!ray_.valid) return best_;
    stack_[size_++] = {0, ray_.ray.tmin};
    accel::ChildRef ref;
    while (pop(ref)) {
      if (accel::is_leaf(ref)) {
        visit_leaf(ref);
        if (ray_.ray.kind == intersect::RayKind::AnyHit && best_.primitive != intersect::kNoPrimitive) return best_;
      } else {
        visit_node(ref);
      }
    }
    return best_;
  }

  /// Entries dropped since the last visit.
  std::uint8_t dropped() const { return dropped_; }

 private:
  bool pop(accel::ChildRef& ref) {
    while (size_ > 0) {
      const StackEntry& top = stack_[--size_];
      if (top.t0 <= best_.t) {
        ref = top.ref;
        return true;
      }
      ++dropped_;
    }
    return false;
  }

  void record(accel::ChildRef ref, unsigned lanes, unsigned detail) {
    steps_->steps.push_back({ref, dropped_, static_cast<std::uint8_t>(lanes), static_cast<std::uint16_t>(detail)});
    dropped_ = 0;
  }

  void visit_node(accel::ChildRef ref) {
    const accel::Node4& node = bvh_.nodes[ref];
    intersect::SlabTimes times;
    const cull::MaskTestResult outcome = test_node_(ray_, ref, best_.t, times);
    const VisitOrder order = sort_survivors(outcome.pass, times.t0);
    if constexpr (kRecord) {
      unsigned detail = static_cast<unsigned>(outcome.uncertain) << 8;
      for (int i = 0; i < order.count; ++i) detail |= static_cast<unsigned>(order.lane[i]) << (2 * i);
      record(ref, times.hit | (static_cast<unsigned>(outcome.pass) << 4), detail);
      if (keyed_)
        for (int lane = 0; lane < kLanes; ++lane)
          if ((times.hit >> lane) & 1u) steps_->keys.push_back(outcome.key[lane]);
    }
    for (int i = order.count - 1; i >= 0; --i) stack_[size_++] = {node.child[order.lane[i]], times.t0[order.lane[i]]};
  }

  void visit_leaf(accel::ChildRef ref) {
    const std::uint32_t first = accel::leaf_first(ref);
    const int count = accel::leaf_count(ref);
    unsigned became_best = 0;
    for (int i = 0; i < count; ++i) {
      const accel::LeafTriangle& triangle = bvh_.triangles[first + i];
      const auto result = intersect::triangle_test(ray_, triangle.v0, triangle.v1, triangle.v2, best_.t);
      if (!result.hit || !intersect::replaces(result.t, triangle.primitive, best_)) continue;
      best_ = {result.t, result.u, result.v, triangle.primitive};
      became_best |= 1u << i;
    }
    if constexpr (kRecord) record(ref, static_cast<unsigned>(count), became_best);
  }

  const NodeTest& test_node_;
  const accel::Bvh4& bvh_;
  const intersect::PreparedRay ray_;
  StepList* steps_;
  const bool keyed_;
  intersect::Hit best_;
  std::uint8_t dropped_ = 0;
  int size_ = 0;
  std::array<StackEntry, kMaxStackEntries> stack_;
};

}  // namespace

int stack_bound(const accel::Bvh4& bvh) { return (kLanes - 1) * bvh.depth + 1; }

Traversal::Traversal(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester)
    : test_node_(bvh, masks, tester) {
  if (stack_bound(bvh) > kMaxStackEntries)
    throw Error("BVH",
                fmt::format("depth {} needs a traversal stack of {} entries; the limit is {}", bvh.depth,
                            stack_bound(bvh), kMaxStackEntries),
                "allow more triangles in a leaf");
}

intersect::Hit Traversal::trace(const intersect::Ray& ray, StepList* steps, const intersect::Hit* known) const {
  if (steps == nullptr) return Walk<false>(test_node_, ray, nullptr, known).run();
  Walk<true> walk(test_node_, ray, steps, known);
  const intersect::Hit hit = walk.run();
  steps->tail_dropped.push_back(walk.dropped());
  steps->first_step.push_back(steps->steps.size());
  steps->first_key.push_back(steps->keys.size());
  return hit;
}

}  // namespace ctu::reference
