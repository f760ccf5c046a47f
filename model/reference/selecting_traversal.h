// The untimed traversal of a scene with local trees: each ray walks the tree that was built for rays like it, and the
// global tree where that one cannot know the answer.
//
// Why nothing is lost: up to a point of the ray in the area, every triangle that it meets is in the area's local tree
// (tree_choice.h). So the local answer is final when the exact point at the hit's t certainly lies in the area; when
// the ray found nothing and the point where it ends, or leaves the bounds of the scene, does; and for an any-hit ray
// whenever it found anything. Else the global tree is walked for what is nearer than the hit there is.
#pragma once

#include <cstdint>
#include <vector>

#include "model/influence/tree_set.h"
#include "model/reference/traversal.h"
#include "model/reference/tree_choice.h"

namespace ctu::reference {

/// What some rays did. A ray has a walk in `local` when it was affine, one in `global` when that was not final or when
/// it was not affine.
struct SelectionRecord {
  std::uint64_t rays = 0;
  std::uint64_t affine = 0;       ///< walked a local tree first
  std::uint64_t final = 0;        ///< ... and had their answer there
  std::uint64_t areas_asked = 0;  ///< tests whether a ray is affine to an area
  StepList local, global;

  Counts local_counts() const { return count_steps(local, 0, local.rays()); }
  Counts global_counts() const { return count_steps(global, 0, global.rays()); }
};

class SelectingTraversal {
 public:
  /// `trees` must outlive this.
  explicit SelectingTraversal(const influence::TreeSet& trees);
  SelectingTraversal(const SelectingTraversal&) = delete;
  SelectingTraversal& operator=(const SelectingTraversal&) = delete;

  /// The ray's hit: what the global tree alone answers, up to triangles that only the rounded triangle test accepts and
  /// to which of several hits an any-hit ray finds first.
  intersect::Hit trace(const intersect::Ray& ray, SelectionRecord* record = nullptr) const;

 private:
  bool is_final(const influence::PreparedArea& area, const intersect::Ray& ray, const intersect::Hit& hit) const;

  const influence::TreeSet& trees_;
  cull::MaskTester no_culling_;
  TreeChoice choice_;
  Traversal global_;
  std::vector<Traversal> local_;
};

}  // namespace ctu::reference
