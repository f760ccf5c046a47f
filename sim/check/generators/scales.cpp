// Sizes: scenes of 1e-20, of 1e20 and of subnormal numbers; scales nested in one tree; hair far thinner than the scene.
#include <cmath>

#include "sim/check/generators.h"
#include "sim/check/generators/stage.h"

namespace ctu::sim::check {
namespace {

void blocks_of_unit(CaseRandom& random, HardCase& out, int unit_exponent) {
  Stage stage(random, out, Frame::scaled(unit_exponent));
  add_blocks(stage, 3, 14);
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = stage.surface_point();
    Vector64 origin = outside_point(random);
    if (random.chance(0.3)) axis_of(origin, random.below(3)) = axis_of(target, random.below(3));
    // Directions of the scene's size, or of length about 1.
    const int exponent = random.chance(0.5) ? random.pick(-2, 2) : -unit_exponent - 10;
    stage.ray({origin, target, RangeMix::Any, exponent});
    if (random.chance(0.15)) stage.nudge(1);
  }
}

void tiny_scenes(CaseRandom& random, HardCase& out) { blocks_of_unit(random, out, random.pick(-82, -76)); }
void huge_scenes(CaseRandom& random, HardCase& out) { blocks_of_unit(random, out, random.pick(52, 58)); }
void subnormal_scenes(CaseRandom& random, HardCase& out) { blocks_of_unit(random, out, random.pick(-149, -136)); }

/// Each scale half to 1/64 of the one before, all about one corner; binary32 is finest there.
void nested_scales(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  double side = 4 * kSide;
  for (int scales = random.pick(6, 14); scales > 0; --scales) {
    for (int triangles = random.pick(1, 4); triangles > 0; --triangles)
      stage.triangle({cell_corner(random, {side, 0, 0}, side), cell_corner(random, {0, side, 0}, side),
                      cell_corner(random, {0, 0, side}, side)});
    if (random.chance(0.5)) stage.triangle({{0, 0, 0}, {side, side, side}, cell_corner(random, {0, 0, 0}, side)});
    side = std::ldexp(side, -random.pick(1, 6));
  }
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = stage.surface_point();
    // From where another scale is, or from far outside.
    const int times = random.pick(-2, 2);
    Vector64 origin = random.chance(0.5) ? stage.surface_point() * times : outside_point(random);
    if (random.chance(0.2)) axis_of(origin, random.below(3)) = axis_of(target, random.below(3));
    stage.ray({origin, target, RangeMix::Any, random.pick(-2, 2)});
    if (random.chance(0.15)) stage.nudge(1);
  }
}

/// Strands of ribbons across the scene, 1e-6 of it wide.
void hair(CaseRandom& random, HardCase& out) {
  constexpr double kWidth = 4e-6 * kSide;
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  for (int strands = random.pick(2, 6); strands > 0; --strands) {
    Vector64 at = each_axis([&] { return random.unit(); }) * (4 * kSide);
    Vector64 along = random.direction() * (kSide / 4.0);
    for (int pieces = random.pick(4, 12); pieces > 0; --pieces) {
      const Vector64 next = at + along, side = scene::any_across(along) * kWidth;
      stage.triangle({at, at + side, next});
      stage.triangle({at + side, next + side, next});
      at = next;
      along = along + random.direction() * (kSide / 16.0);
    }
  }
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = stage.surface_point();
    const double distance = random.scale(-4, 12);
    const Vector64 near = target + random.direction() * distance;
    stage.ray({random.chance(0.5) ? near : outside_point(random), target, RangeMix::Any, random.pick(-2, 2)});
  }
}

constexpr Generator kGenerators[] = {
    {"tiny-scenes", "scenes of size 1e-20", tiny_scenes},
    {"huge-scenes", "scenes of size 1e20", huge_scenes},
    {"subnormal-scenes", "scenes whose coordinates are subnormal or nearly so", subnormal_scenes},
    {"nested-scales", "scales down to 1e-12 of each other in one tree", nested_scales},
    {"hair", "strands 1e-6 of the scene wide", hair},
};

}  // namespace

std::span<const Generator> scale_generators() { return kGenerators; }

}  // namespace ctu::sim::check
