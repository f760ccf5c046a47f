// Directions that slab tests are known to get wrong: parallel to axes, or nearly; zeros of both signs; subnormal;
// components that differ by more than binary32's significand; very short and very long ones.
#include <cmath>

#include "sim/check/generators.h"
#include "sim/check/generators/stage.h"

namespace ctu::sim::check {
namespace {

/// Calls `body(axis, distance)` for rays that start `distance` (lattice units, either sign) before their target on one
/// axis.
template <class Body>
void for_rays_along_axes(Stage& stage, Body&& body) {
  CaseRandom& random = stage.random();
  for (int i = 0; i < kRays; ++i) {
    const int axis = random.below(3);
    body(axis, random.either_sign(random.pick(0, 6) * kSide));
  }
}

void axis_parallel(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_blocks(stage, 3, 14);
  for_rays_along_axes(stage, [&](int axis, double distance) {
    const Vector64 target = stage.surface_point();
    Vector64 origin = target;
    axis_of(origin, axis) -= distance == 0 ? kSide : distance;
    stage.ray({origin, target, RangeMix::Any, random.pick(-2, 2)});
  });
}

/// Along one axis, the other components given by `small(component)` in space; from where the ray drifts through its
/// target.
template <class Small>
void drifting_rays(Stage& stage, Small&& small) {
  CaseRandom& random = stage.random();
  for_rays_along_axes(stage, [&](int axis, double distance) {
    const Vector64 target = stage.surface_point();
    Vector64 origin = target;
    const double along = distance == 0 ? kSide : distance;
    axis_of(origin, axis) -= along;
    Vec3 direction;
    direction[axis] = to_finite(std::ldexp(along, stage.frame().exponent[axis]));
    const int kept = random.below(3);
    for (int a = 0; a < 3; ++a) {
      if (a == axis) continue;
      const float d = a == kept ? 0.0f : small(direction[axis]);
      direction[a] = d;
      axis_of(origin, a) -= std::ldexp(static_cast<double>(d), -stage.frame().exponent[a]);
    }
    stage.ray_along(origin, direction, 1);
  });
}

void nearly_axis_parallel(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_blocks(stage, 3, 14);
  drifting_rays(stage, [&](float main) { return to_finite(main * random.either_sign(random.scale(-60, -8))); });
}

void zero_components(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_blocks(stage, 3, 14);
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = stage.surface_point();
    Vector64 origin = outside_point(random);
    const int axis = random.below(3);
    axis_of(origin, axis) = axis_of(target, axis);
    if (random.chance(0.2)) axis_of(origin, (axis + 1) % 3) = axis_of(target, (axis + 1) % 3);
    stage.ray({origin, target, RangeMix::Any, random.pick(-3, 3)});
    if (random.chance(0.2)) stage.nudge(1);
  }
}

void subnormal_components(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_blocks(stage, 3, 14);
  drifting_rays(stage, [&](float) {
    const int exponent = random.pick(-149, -134);
    return std::ldexp(static_cast<float>(random.pick(-255, 255)), exponent);
  });
  // All components subnormal: small integers of the smallest number.
  for (int i = 0; i < kRays / 4; ++i) stage.ray({outside_point(random), stage.surface_point(), RangeMix::Any, -400});
}

void components_1e30_apart(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_blocks(stage, 3, 14);
  const int lift = random.pick(0, 60);
  for_rays_along_axes(stage, [&](int axis, double distance) {
    const Vector64 target = stage.surface_point();
    Vector64 origin = target;
    const double along = distance == 0 ? kSide : distance;
    axis_of(origin, axis) -= along;
    Vec3 direction;
    for (int a = 0; a < 3; ++a) direction[a] = to_finite(random.either_sign(random.scale(lift - 101, lift - 99)));
    if (random.chance(0.3)) direction[(axis + 1) % 3] = to_finite(random.either_sign(random.scale(-149, lift - 50)));
    direction[axis] = to_finite(std::ldexp(along, lift - 10));
    stage.ray_along(origin, direction, std::ldexp(1.0, stage.frame().exponent[axis] - lift + 10));
  });
}

void direction_lengths(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_blocks(stage, 3, 14);
  for (int i = 0; i < kRays; ++i) {
    stage.ray({outside_point(random), stage.surface_point(), RangeMix::Any, random.pick(-170, 130)});
    if (random.chance(0.3)) stage.nudge(2);
  }
}

constexpr Generator kGenerators[] = {
    {"axis-parallel", "rays along an axis, the other components +0 or -0", axis_parallel},
    {"nearly-axis-parallel", "components 2^-8 to 2^-60 of the largest", nearly_axis_parallel},
    {"zero-components", "one or two components +0 or -0", zero_components},
    {"subnormal-components", "one, two or all components subnormal", subnormal_components},
    {"components-1e30-apart", "components 1e-30 of each other", components_1e30_apart},
    {"direction-lengths", "directions from the smallest to the largest numbers", direction_lengths},
};

}  // namespace

std::span<const Generator> ray_direction_generators() { return kGenerators; }

}  // namespace ctu::sim::check
