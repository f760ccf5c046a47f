// Which of the R x R x R equal cells of a box a ray or a triangle touches, in exact arithmetic. Cell (x, y, z) is
// element x + R (y + R z); cell i of an axis spans lo + i (hi - lo)/R to lo + (i + 1)(hi - lo)/R.
#pragma once

#include <cstdint>
#include <vector>

#include "model/intersect/ray.h"

namespace ctu::oracle {

enum class Cells : std::uint8_t {
  Closed,    ///< a cell owns all of its faces: a point on a shared face touches both cells
  HalfOpen,  ///< a cell owns its lower faces, the last one its upper face too: the cell a clamped floor gives
};

/// Cells touched by the ray's points with t in [t0, t1] (infinities allowed). An axis on which the box is flat has all
/// its cells in the one plane: Closed touches all of them, HalfOpen the first.
std::vector<std::uint8_t> exact_ray_cells(const intersect::Ray& ray, const Vec3& lo, const Vec3& hi, int resolution,
                                          float t0, float t1, Cells cells = Cells::Closed);

/// Closed cells that the closed triangle (of any shape) touches.
std::vector<std::uint8_t> exact_triangle_cells(const Vec3& lo, const Vec3& hi, int resolution, const Vec3& v0,
                                               const Vec3& v1, const Vec3& v2);

/// Closed triangle against closed box.
bool exact_triangle_touches_box(const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& lo, const Vec3& hi);

}  // namespace ctu::oracle
