// A scene with trees of its own for the rays of its lights: a global tree over everything, a local one for each
// influence area, and what says which of them a ray may walk.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "model/influence/local_tree.h"
#include "model/influence/octree.h"

namespace ctu::influence {

struct TreeSetOptions {
  TreeHeuristic local = kLocalHeuristic;
  accel::BuildOptions build;     ///< of all trees
  double tolerance_degrees = 5;  ///< between an affine ray and the rays of its area, 0 to 90
  int octree_levels = kOctreeLevels;
};

class TreeSet {
 public:
  /// `global` is the tree over all of the mesh. Areas that no triangle touches are left out. Throws Error on an area
  /// that is none and on options out of range.
  TreeSet(const scene::Mesh& mesh, accel::Bvh4 global, const std::vector<InfluenceArea>& areas,
          const TreeSetOptions& options);

  const accel::Bvh4& global() const { return global_; }
  const std::vector<PreparedArea>& areas() const { return areas_; }
  const accel::Bvh4& local(std::size_t area) const { return local_[area]; }

  /// The first area that the ray is affine to: tmin is not negative, the origin lies in the area, and the direction
  /// agrees with its rays there, whichever way it points. `asked` counts the areas that were tested. The ray is valid.
  std::optional<std::uint32_t> area_of(const intersect::Ray& ray, std::uint64_t* asked = nullptr) const;

  /// Bytes of the nodes and triangles of all trees, over those of the global tree.
  double memory_ratio() const;

 private:
  accel::Bvh4 global_;
  std::vector<PreparedArea> areas_;
  std::vector<accel::Bvh4> local_;
  AreaOctree octree_;
  double least_cosine_;
};

/// Whether the direction of the ray is within the angle of the rays of the area at its origin, in either sense.
bool runs_along(const InfluenceArea& area, const intersect::Ray& ray, double least_cosine);

}  // namespace ctu::influence
