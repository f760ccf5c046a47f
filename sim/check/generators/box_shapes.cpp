// Boxes that rounding is hard on: flat in one, two or three axes, of aspects to 1e9, far from zero for their size, a
// few units in the last place wide, and reaching to the largest finite number.
#include <cmath>

#include "sim/check/generators.h"
#include "sim/check/generators/stage.h"

namespace ctu::sim::check {
namespace {

void aimed_rays(Stage& stage, int nudged) {
  CaseRandom& random = stage.random();
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = stage.surface_point();
    Vector64 origin = outside_point(random);
    if (random.chance(0.3)) axis_of(origin, random.below(3)) = axis_of(target, random.below(3));
    stage.ray({origin, target, RangeMix::Any, random.pick(-2, 2)});
    if (random.chance(0.2)) stage.nudge(nudged);
  }
}

/// Plates: squares of two triangles in planes across an axis, and blocks among them.
void flat_boxes(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  for (int plates = random.pick(4, 12); plates > 0; --plates) {
    const int axis = random.below(3);
    Vector64 at[4];
    const Vector64 corner = each_axis([&] { return random.pick(0, 24); }) * (kSide / 8.0);
    const double width = random.pick(1, 8) * (kSide / 8.0), height = random.pick(1, 8) * (kSide / 8.0);
    for (int i = 0; i < 4; ++i) {
      at[i] = corner;
      if (i == 1 || i == 2) axis_of(at[i], (axis + 1) % 3) += width;
      if (i >= 2) axis_of(at[i], (axis + 2) % 3) += height;
    }
    stage.triangle({at[0], at[1], at[2]});
    if (random.chance(0.7)) stage.triangle({at[0], at[2], at[3]});
  }
  if (random.chance(0.5)) add_blocks(stage, 1, 3);
  aimed_rays(stage, 1);
}

/// Triangles without area along an axis (boxes flat in two) or in a point (flat in three), among blocks.
void add_flat_triangles(Stage& stage, int flat_axes) {
  CaseRandom& random = stage.random();
  for (int lines = random.pick(4, 12); lines > 0; --lines) {
    const Vector64 from = each_axis([&] { return random.pick(0, 24); }) * (kSide / 8.0);
    Vector64 to = from, between = from;
    if (flat_axes == 2) {
      const int axis = random.below(3);
      axis_of(to, axis) += random.pick(1, 16) * (kSide / 8.0);
      axis_of(between, axis) += random.pick(1, kSide / 8);
    }
    stage.triangle({from, between, to});
  }
}

void line_boxes(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_flat_triangles(stage, 2);
  add_blocks(stage, 1, 4);
  aimed_rays(stage, 1);
}

void point_boxes(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_flat_triangles(stage, 3);
  add_blocks(stage, 1, 4);
  aimed_rays(stage, 1);
}

/// Each axis has its own power of two: sides up to 2^30 (1e9) of each other.
void aspects(CaseRandom& random, HardCase& out) {
  Frame frame;
  for (int& exponent : frame.exponent) exponent = random.pick(-15, 15);
  if (random.chance(0.3)) frame.exponent[random.below(3)] = random.chance(0.5) ? -15 : 15;
  Stage stage(random, out, frame);
  add_blocks(stage, 3, 14);
  aimed_rays(stage, 1);
}

/// The lattice begins as far from zero as binary32 can still tell its points apart, and its unit is up to 2^76: 1e30.
void offsets(CaseRandom& random, HardCase& out) {
  constexpr double kLast = 0xffffff;
  Frame frame = Frame::scaled(random.chance(0.3) ? random.pick(72, 76) : random.pick(-40, 76));
  for (double& offset : frame.offset)
    offset = random.either_sign(std::fmin(std::floor(random.scale(14, 24)), kLast - 4 * kSide));
  Stage stage(random, out, frame);
  add_blocks(stage, 3, 14);
  aimed_rays(stage, 1);
  // From zero, and from the other side of it.
  for (int i = 0; i < kRays / 3; ++i) {
    Vector64 zero;
    for (int a = 0; a < 3; ++a) axis_of(zero, a) = -frame.offset[a] * random.pick(1, 2);
    stage.ray({zero, stage.surface_point()});
  }
}

/// Blocks of 1 to 16 units in the last place: borders of cells are no binary32 numbers.
void few_ulps_wide(CaseRandom& random, HardCase& out) {
  Frame frame = Frame::scaled(random.pick(-60, 60));
  for (double& offset : frame.offset) offset = random.either_sign(std::ldexp(1.0, 23) + random.below(1 << 20));
  if (random.chance(0.5)) frame.offset[random.below(3)] = 0;
  Stage stage(random, out, frame);
  for (int triangles = random.pick(4, 24); triangles > 0; --triangles) {
    const Vector64 at = each_axis([&] { return random.pick(0, 40); });
    const int side = random.pick(1, 16);
    Vector64 corners[3];
    for (Vector64& corner : corners) corner = at + each_axis([&] { return random.pick(0, side); });
    stage.triangle({corners[0], corners[1], corners[2]});
  }
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = stage.surface_point();
    const int reach = random.one_of({64, 4096, 1 << 20});
    Vector64 origin = each_axis([&] { return random.pick(-reach, reach); });
    if (random.chance(0.3)) axis_of(origin, random.below(3)) = axis_of(target, random.below(3));
    stage.ray({origin, target, RangeMix::Any, random.pick(-2, 2)});
  }
}

/// The lattice's last plane is the largest finite number, on some axes the lowest one.
void largest_numbers(CaseRandom& random, HardCase& out) {
  constexpr double kLast = 0xffffff;  // times 2^104: the largest finite number
  Frame frame = Frame::scaled(104);
  for (double& offset : frame.offset) offset = random.chance(0.5) ? kLast - 4 * kSide : -kLast;
  Stage stage(random, out, frame);
  add_blocks(stage, 3, 10);
  // As wide as numbers go: from the lowest to the largest.
  Vector64 low, high, middle;
  for (int a = 0; a < 3; ++a) {
    axis_of(low, a) = -kLast - frame.offset[a];
    axis_of(high, a) = kLast - frame.offset[a];
    axis_of(middle, a) = random.either_sign(random.below(1 << 22)) - frame.offset[a];
  }
  if (random.chance(0.5)) stage.triangle({low, high, middle});
  stage.triangle({Vector64(4, 4, 4) * kSide, Vector64(0, 4, 4) * kSide, Vector64(4, 0, 3) * kSide});
  stage.triangle({{0, 0, 0}, Vector64(0, 4, 4) * kSide, Vector64(4, 0, 3) * kSide});
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = stage.surface_point();
    Vector64 origin;
    for (int a = 0; a < 3; ++a)
      axis_of(origin, a) = random.chance(0.5) ? random.pick(-kSide, 5 * kSide)
                                              : random.either_sign(random.unit() * kLast) - frame.offset[a];
    if (random.chance(0.3)) axis_of(origin, random.below(3)) = axis_of(target, random.below(3));
    stage.ray({origin, target, RangeMix::Any, random.one_of({0, -2, -100, -200})});
  }
}

constexpr Generator kGenerators[] = {
    {"flat-boxes", "boxes flat in one axis, planes of triangles", flat_boxes},
    {"line-boxes", "boxes flat in two axes", line_boxes},
    {"point-boxes", "boxes flat in three axes", point_boxes},
    {"aspects", "boxes of aspect 1 to 1e9", aspects},
    {"offsets", "boxes far from zero for their size, up to 1e30", offsets},
    {"few-ulps-wide", "boxes 1 to 16 units in the last place wide", few_ulps_wide},
    {"largest-numbers", "boxes that touch the largest finite number", largest_numbers},
};

}  // namespace

std::span<const Generator> box_shape_generators() { return kGenerators; }

}  // namespace ctu::sim::check
