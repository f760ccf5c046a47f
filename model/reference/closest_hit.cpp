#include "model/reference/closest_hit.h"

#include <fmt/format.h>

#include <bit>

#include "model/base/error.h"
#include "model/reference/padded_boxes.h"

namespace ctu::reference {
namespace {

using accel::ChildRef;
using intersect::Hit;
using intersect::Ray;

constexpr int kMaxDepth = 80;  // the builder's bound for 2^27 triangles is 63
constexpr int kStackEntries = 3 * kMaxDepth + 4;

template <class Distance>
struct Entry {
  ChildRef child;
  Distance t;
};

/// Puts the children of the set lanes on the stack, the nearest on top.
template <class Distance>
Entry<Distance>* push_far_to_near(const accel::Node4& node, unsigned lanes, const Distance* t, Entry<Distance>* top) {
  Entry<Distance>* const first = top;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const Entry<Distance> entry{node.child[lane], t[lane]};
    Entry<Distance>* at = top++;
    for (; at > first && at[-1].t < entry.t; --at) *at = at[-1];
    *at = entry;
  }
  return top;
}

/// Follows the nearest child down from `ref`, the others going to the stack: to a leaf, or to nothing.
template <class Boxes, class Distance>
ChildRef descend(const accel::Bvh4& bvh, const Boxes& boxes, ChildRef ref, Distance limit, Entry<Distance>*& top) {
  while (accel::is_inner(ref)) {
    const accel::Node4& node = bvh.nodes[ref];
    alignas(16) Distance t[intersect::kLanes];
    const unsigned lanes = boxes.test(node.boxes, limit, t);
    if (lanes == 0) return accel::kEmptyChild;
    if ((lanes & (lanes - 1)) == 0) {
      ref = node.child[std::countr_zero(lanes)];
    } else {
      top = push_far_to_near(node, lanes, t, top);
      ref = (--top)->child;
    }
  }
  return ref;
}

int largest_axis(const Vec3& d) {
  const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  if (z >= x && z >= y) return 2;
  return y >= x ? 1 : 0;
}

}  // namespace

FastTracer::FastTracer(const accel::Bvh4& bvh) : bvh_(&bvh) {
  if (bvh.depth > kMaxDepth)
    throw Error("tree", fmt::format("{} levels deep", bvh.depth), fmt::format("at most {} are walked", kMaxDepth));
  rows_.reserve(bvh.triangles.size());
  for (const accel::LeafTriangle& triangle : bvh.triangles) rows_.emplace_back(triangle);
}

template <bool kAny, class Boxes, class Triangle>
Hit FastTracer::walk(const Ray& ray, const Boxes& boxes, const Triangle& triangle) const {
  using Distance = typename Boxes::Distance;
  Entry<Distance> stack[kStackEntries];
  Entry<Distance>* top = stack;
  *top++ = {0, boxes.limit(ray.tmin)};
  Hit best{ray.tmax, 0, 0, intersect::kNoPrimitive};
  Distance limit = boxes.limit(best.t);
  while (top != stack) {
    const Entry<Distance> entry = *--top;
    if (!(entry.t <= limit)) continue;
    const ChildRef leaf = descend(*bvh_, boxes, entry.child, limit, top);
    if (leaf == accel::kEmptyChild) continue;
    const std::uint32_t first = accel::leaf_first(leaf), last = first + static_cast<std::uint32_t>(accel::leaf_count(leaf));
    for (std::uint32_t i = first; i < last; ++i) {
      const accel::LeafTriangle& candidate = bvh_->triangles[i];
      const intersect::TriangleResult r = triangle.test(rows_[i], candidate, best.t);
      if (!r.hit || !intersect::replaces(r.t, candidate.primitive, best)) continue;
      best = {r.t, r.u, r.v, candidate.primitive};
      if constexpr (kAny) return best;
      limit = boxes.limit(best.t);
    }
  }
  return best;
}

template <bool kAny>
Hit FastTracer::trace(const Ray& ray) const {
  if (!intersect::is_valid(ray)) return {ray.tmax, 0, 0, intersect::kNoPrimitive};
  const int kz = largest_axis(ray.direction);
  const double d = reach(*bvh_, ray.origin);
  if (FastTriangle::fits(ray, d, kz)) {
    const auto largest = std::fabs(ray.direction[kz]);
    return walk<kAny>(ray, FastBoxes(pad(ray, static_cast<float>(d), largest)), FastTriangle(ray, kz));
  }
  const double largest = std::fabs(static_cast<double>(ray.direction[kz]));
  return walk<kAny>(ray, WideBoxes(pad(ray, d, largest)), DefinedTriangle(ray));
}

Hit FastTracer::closest(const Ray& ray) const { return trace<false>(ray); }

bool FastTracer::occluded(const Ray& ray) const { return trace<true>(ray).primitive != intersect::kNoPrimitive; }

}  // namespace ctu::reference
