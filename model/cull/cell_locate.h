// The cells of a box in which a ray's segment begins and ends (Algorithm 1), found from the slab test's times
// and with their uncertainty: the unit's `cell_locate` stage (DESIGN section 5).
#pragma once

#include <cstdint>

#include "model/intersect/slab_test.h"

namespace ctu::cull {

/// Begin and end cell, 5 bits each: begin x,y,z in bits 0..14, end x,y,z in bits 15..29. Bit 31: rounding leaves
/// more candidates than a key can hold, so it proves nothing and the child must be passed.
struct CellKey {
  std::uint32_t packed = 0;
  static constexpr std::uint32_t kUncertain = 1u << 31;
  int begin(int axis) const { return static_cast<int>(packed >> (5 * axis)) & 31; }
  int end(int axis) const { return static_cast<int>(packed >> (15 + 5 * axis)) & 31; }
  void set(int axis, int begin, int end) {
    packed |= static_cast<std::uint32_t>(begin) << (5 * axis) | static_cast<std::uint32_t>(end) << (15 + 5 * axis);
  }
  bool uncertain() const { return (packed & kUncertain) != 0; }
};

/// For a lane that the slab test hit: the half-open (floor) cells of the points at t0 and t1 in an
/// R_ray^3 grid over the box, clamped to the grid; or, where only one axis leaves a doubt, a column of cells that holds
/// both.
CellKey cell_locate(const intersect::PreparedRay& ray, const intersect::SlabTimes& times, const intersect::Box4& boxes,
                    int lane, int ray_resolution);

}  // namespace ctu::cull
