// In exact arithmetic: the floor cells of the first and last points that a ray and a box share.
#pragma once

#include "model/cull/cell_locate.h"
#include "model/intersect/ray.h"

namespace ctu::test {

struct CellIndex {
  int of[3] = {0, 0, 0};
  bool operator==(const CellIndex&) const = default;
};

/// clamp(floor(R (x - lo) / (hi - lo)), 0, R - 1) of the point at time t; 0 on a flat axis.
CellIndex exact_cell_at(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, int resolution, float t);

struct ExactOverlap {
  bool hit = false;
  CellIndex begin, end;
};
ExactOverlap exact_overlap_cells(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, int resolution, float tmin,
                                 float tmax);

/// Whether the sweep from the key's begin to its end holds the points of both cells for certain: the key names them, or
/// it is a column of cells along one axis that has both in it.
bool holds(cull::CellKey key, const CellIndex& first, const CellIndex& last);

}  // namespace ctu::test
