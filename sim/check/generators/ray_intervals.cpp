// Ranges [tmin, tmax] that leave just the hit: of one time only, ending or beginning inside of a cell, or on its
// border.
#include <cmath>

#include "sim/check/generators.h"
#include "sim/check/generators/stage.h"

namespace ctu::sim::check {
namespace {

/// Rays whose range is about the time of a point of the geometry. `target_of(stage)` gives the point.
template <class TargetOf>
void rays_until(CaseRandom& random, HardCase& out, RangeMix mix, TargetOf&& target_of) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  const std::vector<Vector64> blocks = add_blocks(stage, 3, 14);
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = target_of(stage);
    Vector64 origin = outside_point(random);
    if (random.chance(0.3))
      origin = cell_corner(random, blocks[static_cast<std::size_t>(random.below(static_cast<int>(blocks.size())))]);
    if (random.chance(0.2)) axis_of(origin, random.below(3)) = axis_of(target, random.below(3));
    stage.ray({origin, target, mix, random.pick(-8, 8)});
  }
}

void one_time(CaseRandom& random, HardCase& out) {
  rays_until(random, out, RangeMix::AtPoint, [&](Stage& stage) { return stage.surface_point(); });
}

void ends_inside_cells(CaseRandom& random, HardCase& out) {
  rays_until(random, out, RangeMix::Ends, [&](Stage& stage) { return stage.inner_point(); });
}

/// The first edge of a strut runs from corner to corner of its block, so its k/R lie on cell borders of all three axes.
void ends_on_cell_borders(CaseRandom& random, HardCase& out) {
  rays_until(random, out, RangeMix::Ends, [&](Stage& stage) {
    const int triangle = random.below(stage.triangles()), r = random.pick(2, 8);
    const Vector64& from = stage.corner(triangle, 0);
    return from + (stage.corner(triangle, 1) - from) * random.pick(0, r) * (1.0 / r);
  });
}

constexpr Generator kGenerators[] = {
    {"one-time", "tmin = tmax, the time of a point of the geometry", one_time},
    {"ends-inside-cells", "ranges that begin or end at a hit inside of a cell", ends_inside_cells},
    {"ends-on-cell-borders", "ranges that begin or end at a hit on a border of cells", ends_on_cell_borders},
};

}  // namespace

std::span<const Generator> ray_interval_generators() { return kGenerators; }

}  // namespace ctu::sim::check
