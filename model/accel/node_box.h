// The boxes of a 4-wide node: the same for a tree that is built and one that is refitted, signs of zeros included, so
// what is grown by what, in which order, is said once.
#pragma once

#include "model/accel/box3.h"
#include "model/accel/bvh4.h"

namespace ctu::accel {

inline Vec3 to_vec3(__m128 v) {
  alignas(16) float f[4];
  _mm_store_ps(f, v);
  return {f[0], f[1], f[2]};
}

inline Box3 box_of(const scene::Sphere& sphere) {
  return {to_vector(lower_corner(sphere)), to_vector(upper_corner(sphere))};
}

/// Of `count` primitives. Binary32 vertices bound themselves exactly: nothing is rounded, nothing padded. Spheres are
/// rounded outward.
inline Box3 box_of_triangles(const LeafTriangle* triangles, int count) {
  Box3 box = Box3::empty();
  for (int i = 0; i < count; ++i) {
    if (triangles[i].is_sphere()) {
      box.grow(box_of(triangles[i].sphere()));
      continue;
    }
    box.grow(to_vector(triangles[i].v0));
    box.grow(to_vector(triangles[i].v1));
    box.grow(to_vector(triangles[i].v2));
  }
  return box;
}

inline Box3 lane_box(const Node4& node, int lane) {
  const intersect::Box4& b = node.boxes;
  return {_mm_setr_ps(b.lo[0][lane], b.lo[1][lane], b.lo[2][lane], 0.0f),
          _mm_setr_ps(b.hi[0][lane], b.hi[1][lane], b.hi[2][lane], 0.0f)};
}

inline void set_lane_box(Node4& node, int lane, const Box3& box) {
  const Vec3 lower = to_vec3(box.lower), upper = to_vec3(box.upper);
  for (int axis = 0; axis < 3; ++axis) {
    node.boxes.lo[axis][lane] = lower[axis];
    node.boxes.hi[axis][lane] = upper[axis];
  }
}

/// Of the four lanes; empty lanes hold nothing.
inline Box3 box_of_lanes(const Node4& node) {
  Box3 box = Box3::empty();
  for (int lane = 0; lane < intersect::kLanes; ++lane) box.grow(lane_box(node, lane));
  return box;
}

}  // namespace ctu::accel
