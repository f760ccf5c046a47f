// The same rays through a scene's global tree alone and through the trees that they select: the work of each, and every
// answer that differs, judged by exact arithmetic.
#pragma once

#include <cstdint>
#include <span>

#include "model/influence/tree_set.h"
#include "model/reference/selecting_traversal.h"
#include "model/scene/scene.h"

namespace ctu::sim {

struct SelectionSurvey {
  reference::SelectionRecord record;  ///< of the rays as they are
  reference::Counts alone;            ///< ... in the global tree
  std::uint64_t changed = 0;          ///< rays whose closest hit differs in a bit, or any-hit rays found by one only
  std::uint64_t lost = 0;             ///< ... of these, hits that exact arithmetic says were lost

  /// Tests of four boxes or of a triangle, a ray, in the trees that the rays select.
  double selecting_cost() const;
};

/// `mesh` is that of the trees. Any-hit rays are asked for their closest hits as well.
SelectionSurvey survey_selection(const scene::Mesh& mesh, const influence::TreeSet& trees,
                                 std::span<const intersect::Ray> rays);

}  // namespace ctu::sim
