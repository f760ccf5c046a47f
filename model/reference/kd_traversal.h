// The untimed traversal of a kd-tree, with ray-box culling in its leaves or without: what "Ray-Box Culling for Tree
// Structures" measures, and what no answer of it may lose.
//
// The order is pbrt's: the child that the ray enters first, the other on a stack with the interval in which the ray is
// there, until what is left begins beyond the best hit. pbrt's intervals end at one rounded t; here the t of a plane is
// enclosed, the near child's interval ends at the upper bound and the far one's begins at the lower: a cell that the
// ray meets in exact arithmetic is visited, and its interval encloses the ray's stay.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "model/accel/kd_build.h"
#include "model/accel/kd_tree.h"
#include "model/cull/leaf_culling.h"
#include "model/intersect/plane_time.h"
#include "model/reference/primitive_test.h"

namespace ctu::reference {

struct KdCounts {
  std::uint64_t rays = 0;
  std::uint64_t inner_visits = 0, leaf_visits = 0;  ///< N_T is their sum
  cull::RayBoxCounts leaves;

  std::uint64_t traversals() const { return inner_visits + leaf_visits; }
  KdCounts& operator+=(const KdCounts& o) {
    rays += o.rays;
    inner_visits += o.inner_visits;
    leaf_visits += o.leaf_visits;
    leaves += o.leaves;
    return *this;
  }
};

/// One ray on its way through the tree. `Box` is as in cull::visit_leaf.
template <class Box, bool kSpheres>
class KdWalk {
 public:
  KdWalk(const accel::KdTree& tree, const intersect::Ray& ray, KdCounts& counts)
      : tree_(tree), ray_(intersect::prepare_ray(ray)), counts_(counts) {
    best_.t = ray.tmax;
  }

  intersect::Hit run() {
    ++counts_.rays;
    float tmin = 0, tmax = 0;
    if (!ray_.valid || !enter(tmin, tmax)) return best_;
    push(0, tmin, tmax);
    while (size_ > 0) {
      const Entry entry = stack_[--size_];
      if (!(entry.tmin <= best_.t)) continue;
      descend(entry);
      if (ray_.ray.kind == intersect::RayKind::AnyHit && best_.primitive != intersect::kNoPrimitive) break;
    }
    return best_;
  }

 private:
  struct Entry {
    std::uint32_t node;
    float tmin, tmax;
  };

  /// The ray's interval in the scene's box; false if it misses.
  bool enter(float& tmin, float& tmax) const {
    tmin = ray_.ray.tmin;
    tmax = ray_.ray.tmax;
    for (int axis = 0; axis < 3; ++axis) {
      if ((ray_.zero_axes >> axis & 1) != 0) {
        const float o = ray_.ray.origin[axis];
        if (o < tree_.lower[axis] || o > tree_.upper[axis]) return false;
        continue;
      }
      const bool backwards = (ray_.negative_axes >> axis & 1) != 0;
      const float near = backwards ? tree_.upper[axis] : tree_.lower[axis];
      const float far = backwards ? tree_.lower[axis] : tree_.upper[axis];
      tmin = std::max(tmin, intersect::plane_time(ray_, axis, near).down);
      tmax = std::min(tmax, intersect::plane_time(ray_, axis, far).up);
    }
    return tmin <= tmax;
  }

  void push(std::uint32_t node, float tmin, float tmax) { stack_[size_++] = {node, tmin, tmax}; }

  /// Down the near children to a leaf.
  void descend(Entry at) {
    const accel::KdNode* node = &tree_.nodes[at.node];
    while (!node->is_leaf()) {
      ++counts_.inner_visits;
      at = below(*node, at);
      node = &tree_.nodes[at.node];
    }
    ++counts_.leaf_visits;
    visit_leaf(*node, at.tmin, at.tmax);
  }

  /// The child to go to; the other, where the ray may be in it, goes on the stack.
  Entry below(const accel::KdNode& node, const Entry& at) {
    const int axis = node.axis();
    const std::uint32_t lower = at.node + 1, upper = node.upper_child();
    if ((ray_.zero_axes >> axis & 1) != 0) {
      const float o = ray_.ray.origin[axis];
      if (o == node.plane()) push(upper, at.tmin, at.tmax);
      return {o <= node.plane() ? lower : upper, at.tmin, at.tmax};
    }
    const bool backwards = (ray_.negative_axes >> axis & 1) != 0;
    const std::uint32_t near = backwards ? upper : lower, far = backwards ? lower : upper;
    const intersect::PlaneTime t = intersect::plane_time(ray_, axis, node.plane());
    if (t.up < at.tmin) return {far, at.tmin, at.tmax};
    if (t.down > at.tmax) return {near, at.tmin, at.tmax};
    push(far, std::max(at.tmin, t.down), at.tmax);
    return {near, at.tmin, std::min(at.tmax, t.up)};
  }

  void visit_leaf(const accel::KdNode& leaf, float tmin, float tmax) {
    const std::uint32_t first = leaf.first();
    const auto box_of = [&](std::uint32_t i) -> const accel::PrimitiveBox& { return tree_.box(first + i); };
    const auto test = [&](std::uint32_t i) {
      return test_primitive<kSpheres>(ray_, tree_.primitives[tree_.references[first + i]], best_);
    };
    cull::visit_leaf<Box>(ray_.ray, tmin, tmax, leaf.references(), best_.t, ray_.ray.kind == intersect::RayKind::AnyHit,
                          box_of, test, counts_.leaves);
  }

  const accel::KdTree& tree_;
  const intersect::PreparedRay ray_;
  KdCounts& counts_;
  intersect::Hit best_;
  int size_ = 0;
  std::array<Entry, accel::kMostKdDepth + 1> stack_;  // one a level, and the root
};

/// The ray's hit, as reference::Traversal finds it. `Box` is cull::RayBox or cull::NoRayBox. Adds to `counts`.
template <class Box>
intersect::Hit trace_kd(const accel::KdTree& tree, const intersect::Ray& ray, KdCounts& counts) {
  if (tree.spheres != 0) return KdWalk<Box, true>(tree, ray, counts).run();
  return KdWalk<Box, false>(tree, ray, counts).run();
}

}  // namespace ctu::reference
