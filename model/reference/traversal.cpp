#include "model/reference/traversal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/reference/primitive_test.h"
#include "model/reference/visit_order.h"

namespace ctu::reference {
namespace {

using intersect::kLanes;

struct StackEntry {
  accel::ChildRef ref;
  float t0;
};
/// Ray boxes need to know where the ray leaves, too.
struct StackEntryWithExit : StackEntry {
  float t1;
};

/// A finished ray is one more in the list.
void close_ray(StepList& steps, std::uint8_t tail_dropped) {
  steps.tail_dropped.push_back(tail_dropped);
  steps.first_step.push_back(steps.steps.size());
  steps.first_key.push_back(steps.keys.size());
  steps.first_met.push_back(steps.met.size());
}

/// What ray boxes do in the leaves of a walk.
enum class RayBoxes { None, CutAtHits, OncePerLeaf };

/// Where a ray begins: at a root, or at the entries of its packet.
struct Start {
  accel::ChildRef root = 0;
  const EntryList* entries = nullptr;
};

/// One ray on its way through the tree. `kRecord` decides once whether the event sequence is written, `kSpheres`
/// whether a leaf may hold spheres, `kRayBoxes` how ray boxes cull its primitives.
template <bool kRecord, bool kSpheres, RayBoxes kRayBoxes>
class Walk {
 public:
  static constexpr bool kRayBox = kRayBoxes != RayBoxes::None;
  using Entry = std::conditional_t<kRayBox, StackEntryWithExit, StackEntry>;

  Walk(const NodeTest& test_node, const accel::PrimitiveBox* leaf_boxes, const intersect::Ray& ray, StepList* steps,
       const intersect::Hit* known)
      : test_node_(test_node),
        leaf_boxes_(leaf_boxes),
        bvh_(test_node.bvh()),
        ray_(intersect::prepare_ray(ray)),
        steps_(steps),
        keyed_(cull::reads_tables(test_node.tester().design())) {
    best_ = known != nullptr ? *known : intersect::Hit{ray.tmax, 0, 0, intersect::kNoPrimitive};
  }

  intersect::Hit run(const Start& start) {
    if (!ray_.valid) return best_;
    if (start.entries == nullptr) push(start.root, ray_.ray.tmin, ray_.ray.tmax);
    for (int i = start.entries == nullptr ? 0 : start.entries->count(); i-- > 0;)
      push((*start.entries)[i].ref, (*start.entries)[i].t0, ray_.ray.tmax);
    Entry at;
    while (pop(at)) {
      if (accel::is_leaf(at.ref)) {
        visit_leaf(at);
        if (ray_.ray.kind == intersect::RayKind::AnyHit && best_.primitive != intersect::kNoPrimitive) return best_;
      } else {
        visit_node(at.ref);
      }
    }
    return best_;
  }

  /// Entries dropped since the last visit.
  std::uint8_t dropped() const { return dropped_; }
  /// All zero without ray boxes.
  const cull::RayBoxCounts& box_counts() const { return box_counts_; }

 private:
  void push(accel::ChildRef ref, float t0, float t1) {
    if constexpr (kRayBox)
      stack_[size_++] = {{ref, t0}, t1};
    else
      stack_[size_++] = {ref, t0};
  }

  bool pop(Entry& at) {
    while (size_ > 0) {
      const Entry& top = stack_[--size_];
      if (top.t0 <= best_.t) {
        at = top;
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
    for (int i = order.count - 1; i >= 0; --i) {
      const int lane = order.lane[i];
      push(node.child[lane], times.t0[lane], times.t1[lane]);
    }
  }

  void visit_leaf(const Entry& at) {
    const std::uint32_t first = accel::leaf_first(at.ref);
    const auto count = static_cast<std::uint32_t>(accel::leaf_count(at.ref));
    unsigned became_best = 0;
    const auto test = [&](std::uint32_t i) {
      const bool best = test_primitive<kSpheres>(ray_, bvh_.triangles[first + i], best_);
      if (best) became_best |= 1u << i;
      return best;
    };
    std::uint64_t tested = count;
    // An any-hit ray leaves after the leaf, as without culling.
    const auto box_of = [&](std::uint32_t i) -> const accel::PrimitiveBox& { return leaf_boxes_[first + i]; };
    if constexpr (kRayBoxes == RayBoxes::CutAtHits) {
      const std::uint64_t before = box_counts_.primitive_tests;
      cull::visit_leaf<cull::RayBox>(ray_.ray, at.t0, at.t1, count, best_.t, false, box_of, test, box_counts_);
      tested = box_counts_.primitive_tests - before;
    } else if constexpr (kRayBoxes == RayBoxes::OncePerLeaf) {
      const unsigned met = cull::boxes_met(ray_.ray, at.t0, std::min(at.t1, best_.t), count, box_of);
      for (unsigned rest = met; rest != 0; rest &= rest - 1) test(static_cast<std::uint32_t>(std::countr_zero(rest)));
      tested = static_cast<std::uint64_t>(std::popcount(met));
      if constexpr (kRecord) steps_->met.push_back(static_cast<std::uint16_t>(met));
      count_leaf(count, tested);
    } else {
      for (std::uint32_t i = 0; i < count; ++i) test(i);
    }
    if constexpr (kRecord) record(at.ref, static_cast<unsigned>(tested), became_best);
  }

  void count_leaf(std::uint32_t count, std::uint64_t tested) {
    box_counts_.primitive_tests += tested;
    if (count < cull::kLeastCulledPrimitives) return;
    ++box_counts_.created;
    box_counts_.box_tests += count;
  }

  const NodeTest& test_node_;
  const accel::PrimitiveBox* const leaf_boxes_;
  const accel::Bvh4& bvh_;
  const intersect::PreparedRay ray_;
  StepList* steps_;
  const bool keyed_;
  intersect::Hit best_;
  std::uint8_t dropped_ = 0;
  int size_ = 0;
  std::array<Entry, kMaxStackEntries> stack_;
  cull::RayBoxCounts box_counts_;
};

struct Outcome {
  intersect::Hit hit;
  std::uint8_t dropped;
  cull::RayBoxCounts box_counts;
};

/// Rays are walked with the boxes of `leaf_boxes`, or none.
template <bool kRecord, RayBoxes kRayBoxes>
Outcome walk(const NodeTest& test_node, const accel::PrimitiveBox* leaf_boxes, const intersect::Ray& ray,
             StepList* steps, const intersect::Hit* known, const Start& start) {
  const auto run = [&](auto spheres) {
    Walk<kRecord, spheres(), kRayBoxes> walk(test_node, leaf_boxes, ray, steps, known);
    const intersect::Hit hit = walk.run(start);
    return Outcome{hit, walk.dropped(), walk.box_counts()};
  };
  return test_node.bvh().spheres != 0 ? run(std::true_type()) : run(std::false_type());
}

template <bool kRecord>
Outcome walk(const NodeTest& test_node, const std::vector<accel::PrimitiveBox>* leaf_boxes, cull::RayBoxRule rule,
             const intersect::Ray& ray, StepList* steps, const intersect::Hit* known, const Start& start) {
  if (leaf_boxes == nullptr) return walk<kRecord, RayBoxes::None>(test_node, nullptr, ray, steps, known, start);
  if (rule == cull::RayBoxRule::CutAtHits)
    return walk<kRecord, RayBoxes::CutAtHits>(test_node, leaf_boxes->data(), ray, steps, known, start);
  return walk<kRecord, RayBoxes::OncePerLeaf>(test_node, leaf_boxes->data(), ray, steps, known, start);
}

}  // namespace

std::vector<accel::PrimitiveBox> leaf_boxes(const accel::Bvh4& bvh) {
  std::vector<accel::PrimitiveBox> boxes;
  boxes.reserve(bvh.triangles.size());
  for (const accel::LeafTriangle& primitive : bvh.triangles) boxes.push_back(accel::box_of_primitive(primitive));
  return boxes;
}

int stack_bound(const accel::Bvh4& bvh) { return (kLanes - 1) * bvh.depth + 1; }

Traversal::Traversal(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester,
                     const std::vector<accel::PrimitiveBox>* leaf_boxes, cull::RayBoxRule rule)
    : test_node_(bvh, masks, tester), leaf_boxes_(leaf_boxes), rule_(rule) {
  if (stack_bound(bvh) > kMaxStackEntries)
    throw Error("BVH",
                fmt::format("depth {} needs a traversal stack of {} entries; the limit is {}", bvh.depth,
                            stack_bound(bvh), kMaxStackEntries),
                "allow more triangles in a leaf");
}

intersect::Hit Traversal::trace(const intersect::Ray& ray, StepList* steps, const intersect::Hit* known,
                                cull::RayBoxCounts* box_counts) const {
  const Outcome outcome = steps == nullptr ? walk<false>(test_node_, leaf_boxes_, rule_, ray, nullptr, known, {})
                                           : walk<true>(test_node_, leaf_boxes_, rule_, ray, steps, known, {});
  if (box_counts != nullptr) *box_counts += outcome.box_counts;
  if (steps != nullptr) close_ray(*steps, outcome.dropped);
  return outcome.hit;
}

intersect::Hit Traversal::trace_in(std::uint32_t tree, const intersect::Ray& ray, StepList* steps) const {
  const Start start{test_node_.bvh().root(tree), nullptr};
  const Outcome outcome = steps == nullptr ? walk<false>(test_node_, leaf_boxes_, rule_, ray, nullptr, nullptr, start)
                                           : walk<true>(test_node_, leaf_boxes_, rule_, ray, steps, nullptr, start);
  if (steps != nullptr) close_ray(*steps, outcome.dropped);
  return outcome.hit;
}

intersect::Hit Traversal::trace_from(const EntryList& entries, const intersect::Ray& ray, StepList& steps) const {
  const Outcome outcome = walk<true>(test_node_, leaf_boxes_, rule_, ray, &steps, nullptr, {0, &entries});
  close_ray(steps, outcome.dropped);
  return outcome.hit;
}

}  // namespace ctu::reference
