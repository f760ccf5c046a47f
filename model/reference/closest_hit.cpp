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
constexpr int kStackEntries = (kWideLanes - 1) * kMaxDepth + 1;

template <class Distance>
struct Entry {
  ChildRef child;
  Distance t;
};

/// Removes the lowest set lane from `lanes`.
template <class Distance>
[[gnu::always_inline]] inline Entry<Distance> take_lane(const Node8& node, const Distance* t, unsigned& lanes) {
  const int lane = std::countr_zero(lanes);
  lanes &= lanes - 1;
  return {node.child[lane], t[lane]};
}

/// Puts the children of the set lanes but the nearest on the stack, farthest first; returns the nearest.
template <class Distance>
[[gnu::always_inline]] inline ChildRef nearest_of(const Node8& node, unsigned lanes, const Distance* t,
                                                  Entry<Distance>*& top) {
  Entry<Distance> nearest = take_lane(node, t, lanes);
  Entry<Distance>* const first = top;
  while (lanes != 0) {
    Entry<Distance> farther = take_lane(node, t, lanes);
    if (farther.t < nearest.t) std::swap(farther, nearest);
    Entry<Distance>* at = top++;
    for (; at > first && at[-1].t < farther.t; --at) *at = at[-1];
    *at = farther;
  }
  return nearest.child;
}

/// Follows the nearest child down from `ref`, the others going to the stack: to a leaf, or to nothing.
template <class Boxes, class Distance>
[[gnu::always_inline]] inline ChildRef descend(const Node8* nodes, const Boxes& boxes, ChildRef ref, Distance limit,
                                               Entry<Distance>*& top) {
  while (accel::is_inner(ref)) {
    const Node8& node = nodes[ref];
    alignas(32) Distance t[kWideLanes];
    const unsigned lanes = boxes.test(node, limit, t);
    if (lanes == 0) return accel::kEmptyChild;
    ref = nearest_of(node, lanes, t, top);
  }
  return ref;
}

int largest_axis(const Vec3& d) {
  const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  if (z >= x && z >= y) return 2;
  return y >= x ? 1 : 0;
}

}  // namespace

FastTracer::FastTracer(const accel::Bvh4& bvh)
    : lower_(bvh.lower), upper_(bvh.upper), has_spheres_(bvh.spheres != 0), nodes_(widen(bvh)) {
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
  *top++ = {0, ray.tmin};
  Hit best{ray.tmax, 0, 0, intersect::kNoPrimitive};
  Distance limit = best.t;
  while (top != stack) {
    const Entry<Distance> entry = *--top;
    if (!(entry.t <= limit)) continue;
    const ChildRef leaf = descend(nodes_.data(), boxes, entry.child, limit, top);
    if (leaf == accel::kEmptyChild) continue;
    const std::uint32_t first = accel::leaf_first(leaf),
                        last = first + static_cast<std::uint32_t>(accel::leaf_count(leaf));
    for (std::uint32_t i = first; i < last; ++i) {
      const intersect::TriangleResult r = triangle.test(rows_[i], best.t);
      if (!r.hit || !intersect::replaces(r.t, rows_[i].primitive() & ~accel::LeafTriangle::kSphereBit, best)) continue;
      best = {r.t, r.u, r.v, rows_[i].primitive() & ~accel::LeafTriangle::kSphereBit};
      if constexpr (kAny) return best;
      limit = best.t;
    }
  }
  return best;
}

/// Scenes without spheres do not ask what a primitive is.
template <bool kAny, class Boxes, class Triangle>
Hit FastTracer::walk_leaves_of(const Ray& ray, const Boxes& boxes, const Triangle& triangle) const {
  if (has_spheres_) return walk<kAny>(ray, boxes, WithSpheres<Triangle>(ray, triangle));
  return walk<kAny>(ray, boxes, triangle);
}

template <bool kAny>
Hit FastTracer::trace(const Ray& ray) const {
  const int kz = largest_axis(ray.direction);
  Reach reach(lower_, upper_, ray.origin);
  if (has_spheres_) reach.distance *= kSphereReach;
  if (!intersect::is_valid(ray)) return {ray.tmax, 0, 0, intersect::kNoPrimitive};
  if (FastBoxes::fit(ray, reach, kz) && FastTriangle::fits(ray, kz))
    return walk_leaves_of<kAny>(ray, FastBoxes(ray, reach, kz), FastTriangle(ray, kz));
  return walk_leaves_of<kAny>(ray, WideBoxes(ray, reach, kz), DefinedTriangle(ray));
}

Hit FastTracer::closest(const Ray& ray) const { return trace<false>(ray); }

bool FastTracer::occluded(const Ray& ray) const { return trace<true>(ray).primitive != intersect::kNoPrimitive; }

}  // namespace ctu::reference
