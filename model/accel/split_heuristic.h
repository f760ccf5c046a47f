// What guides the builder: how likely a ray is to visit a box, and along which axes a node may be cut. The two are
// values that compose, so that every heuristic runs through the one builder.
//
// A chance is a function of a box in the builder's scaled coordinates (build_by.h); any factor common to all boxes will
// do. Axes have choose(box, chance, cut_on): the cut of the node with this box and chance, where cut_on(axis) is the
// best cut across the axis, or none when no two centres differ there.
#pragma once

#include "model/accel/box3.h"
#include "model/accel/cut.h"

namespace ctu::accel {

/// The surface area heuristic: rays from everywhere, in all directions alike.
struct SurfaceArea {
  float operator()(const Box3& box) const { return half_area(box); }
};

/// The best cut of all three axes.
struct AllAxes {
  template <class CutOn>
  Cut choose(const Box3&, float, CutOn&& cut_on) const {
    Cut best;
    for (int axis = 0; axis < 3; ++axis) best.offer(cut_on(axis));
    return best;
  }
};

/// The axes of a box in the order of its extents, longest first; equal ones in the order x, y, z.
struct AxisOrder {
  int axis[3] = {0, 1, 2};
};
AxisOrder longest_first(const Box3& box);

/// The longest splitting plane heuristic (LSPH): only the longest axis is cut, the next where that one cannot be.
struct LongestAxis {
  template <class CutOn>
  Cut choose(const Box3& box, float, CutOn&& cut_on) const {
    for (const int axis : longest_first(box).axis)
      if (const Cut cut = cut_on(axis); cut.axis >= 0) return cut;
    return {};
  }
};

template <class Chance, class Axes>
struct SplitHeuristic {
  Chance chance;
  Axes axes;
};

}  // namespace ctu::accel
