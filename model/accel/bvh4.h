// The 4-wide BVH as the software walks it. The bytes the unit fetches are made from it by image.h.
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/box_frame.h"
#include "model/accel/child_ref.h"
#include "model/intersect/slab_test.h"
#include "model/numeric/vec3.h"
#include "model/scene/sphere.h"

namespace ctu::accel {

/// A node: the boxes of up to four children and where they are. Empty lanes come last.
struct alignas(64) Node4 {
  intersect::Box4 boxes;
  ChildRef child[intersect::kLanes];
  BoxFrame frame;  ///< that the boxes are stored in, where they are of reduced precision (quantize.h)
};
static_assert(sizeof(Node4) == 128);

/// A triangle in leaf order, with the id it has in the scene; or a sphere: its centre is v0, its radius v1.x, the rest
/// 0, and its id has kSphereBit.
struct LeafTriangle {
  Vec3 v0, v1, v2;
  std::uint32_t primitive;

  static constexpr std::uint32_t kSphereBit = 0x80000000u;
  static LeafTriangle of(const scene::Sphere& s, std::uint32_t id) {
    return {s.centre, {s.radius, 0, 0}, {0, 0, 0}, id | kSphereBit};
  }
  bool is_sphere() const { return (primitive & kSphereBit) != 0; }
  scene::Sphere sphere() const { return {v0, v1.x}; }
  std::uint32_t id() const { return primitive & ~kSphereBit; }
};
static_assert(sizeof(LeafTriangle) == 40);

/// Node 0 is the root, present even when the scene has one triangle; children come after their parent, but
/// in a tree that partition.h has ordered: that one can be walked, not refit or given masks. Trees for some rays only
/// may lie behind it (forest.h).
struct Bvh4 {
  std::vector<Node4> nodes;
  std::vector<ChildRef> further_roots;  ///< of trees number 1 and on; tree 0 is the one from node 0
  std::vector<LeafTriangle> triangles;
  std::uint32_t spheres = 0;  ///< how many of them are spheres
  Vec3 lower, upper;          ///< bounds of the scene
  int depth = 0;              ///< nodes on the longest path from a root

  std::uint32_t trees() const { return 1 + static_cast<std::uint32_t>(further_roots.size()); }
  ChildRef root(std::uint32_t tree) const { return tree == 0 ? 0 : further_roots[tree - 1]; }
};

}  // namespace ctu::accel
