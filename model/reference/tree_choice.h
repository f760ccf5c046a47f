// Which local tree is sure to have a ray's whole answer.
#pragma once

#include <cstdint>
#include <optional>

#include "model/influence/tree_set.h"
#include "model/intersect/ray.h"

namespace ctu::reference {

/// An area is convex. When a ray's origin and the point where it ends, or leaves the bounds of the scene, both lie in
/// it, so does all of the way between, and every primitive that the ray meets has a point in the area and is in its
/// local tree.
class TreeChoice {
 public:
  /// `trees` must outlive this.
  explicit TreeChoice(const influence::TreeSet& trees);

  /// Whether the ray, which is affine to the area, certainly lies in it as far as there is anything to meet.
  bool ends_in(const influence::PreparedArea& area, const intersect::Ray& ray) const;

  /// The area that the ray is affine to, when the ray certainly lies in it. None for a ray that is not valid.
  std::optional<std::uint32_t> area_of(const intersect::Ray& ray) const;

 private:
  const influence::TreeSet& trees_;
  intersect::Box4 bounds_;  ///< of the scene, in the first lane
};

}  // namespace ctu::reference
