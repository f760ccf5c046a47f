#include "model/accel/refit.h"

#include <fmt/format.h>

#include <cstring>

#include "model/accel/leaf_record.h"
#include "model/accel/mesh_check.h"
#include "model/accel/node_box.h"
#include "model/base/error.h"
#include "model/base/parallel.h"

namespace ctu::accel {
namespace {

constexpr std::size_t kChunkNodes = 4096;

void check(const Bvh4& bvh, const scene::Mesh& moved, int threads) {
  if (moved.primitives() != bvh.triangles.size() || moved.spheres.size() != bvh.spheres)
    throw Error("refit",
                fmt::format("the mesh has {} triangles and {} spheres, the tree {} and {}", moved.triangles.size(),
                            moved.spheres.size(), bvh.triangles.size() - bvh.spheres, bvh.spheres),
                "give the mesh that the tree was built from, with moved vertices; build a new tree for another mesh");
  checked_bounds(moved, threads);
}

/// Moves a leaf's triangles; whether one of them has other bits than before.
bool move_leaf(LeafTriangle* triangles, int count, const scene::Mesh& moved) {
  bool changed = false;
  for (int i = 0; i < count; ++i) {
    LeafTriangle& triangle = triangles[i];
    const LeafTriangle next = leaf_record(moved, triangle.id());
    if (std::memcmp(&next, &triangle, sizeof next) == 0) continue;
    triangle = next;
    changed = true;
  }
  return changed;
}

bool same_bits(const Vec3& a, const Vec3& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Sets the box of a child below which a triangle has moved.
void set_child(Bvh4& bvh, std::uint32_t node, int lane, const Box3& box, RefitChanges& changes) {
  const Box3 before = lane_box(bvh.nodes[node], lane);
  const bool same =
      same_bits(to_vec3(before.lower), to_vec3(box.lower)) && same_bits(to_vec3(before.upper), to_vec3(box.upper));
  if (!same) set_lane_box(bvh.nodes[node], lane, box);
  changes.set(node, lane, !same);
}

/// A leaf belongs to one node, and a node's flags to the chunk that it is in.
void refit_leaves(Bvh4& bvh, const scene::Mesh& moved, int threads, RefitChanges& changes) {
  parallel_chunks(bvh.nodes.size(), kChunkNodes, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        const ChildRef ref = bvh.nodes[i].child[lane];
        if (!is_leaf(ref)) continue;
        LeafTriangle* const triangles = bvh.triangles.data() + leaf_first(ref);
        if (move_leaf(triangles, leaf_count(ref), moved))
          set_child(bvh, static_cast<std::uint32_t>(i), lane, box_of_triangles(triangles, leaf_count(ref)), changes);
      }
  });
}

/// Children come after their parent, so a pass from the back meets a node when its own boxes are done. It reads below
/// only where something has moved, and so is not worth threads.
void refit_inner_boxes(Bvh4& bvh, RefitChanges& changes) {
  for (std::size_t i = bvh.nodes.size(); i-- > 0;)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const ChildRef ref = bvh.nodes[i].child[lane];
      if (is_inner(ref) && changes.any(ref))
        set_child(bvh, static_cast<std::uint32_t>(i), lane, box_of_lanes(bvh.nodes[ref]), changes);
    }
}

}  // namespace

RefitChanges refit(Bvh4& bvh, const scene::Mesh& moved, int threads) {
  check(bvh, moved, threads);
  RefitChanges changes(bvh.nodes.size());
  refit_leaves(bvh, moved, threads, changes);
  refit_inner_boxes(bvh, changes);
  if (!bvh.nodes.empty() && changes.any(0)) {
    const Box3 bounds = box_of_lanes(bvh.nodes[0]);
    bvh.lower = to_vec3(bounds.lower);
    bvh.upper = to_vec3(bounds.upper);
  }
  return changes;
}

}  // namespace ctu::accel
