// Triangles: needles, ones without area, thousands in one place; plain ones and ones of arbitrary bits to compare with.
#include <cmath>
#include <limits>

#include "model/numeric/round.h"
#include "sim/check/generators.h"
#include "sim/check/generators/stage.h"

namespace ctu::sim::check {
namespace {

Vector64 anywhere(CaseRandom& random) {
  return each_axis([&] { return random.unit(); }) * (4 * kSide);
}

void aim_at_surface(Stage& stage, int rays) {
  CaseRandom& random = stage.random();
  for (int i = 0; i < rays; ++i) {
    stage.ray({random.chance(0.3) ? anywhere(random) : outside_point(random), stage.surface_point(), RangeMix::Any,
               random.pick(-2, 2)});
    if (random.chance(0.1)) stage.nudge(1);
  }
}

/// Long edges across the scene, the third vertex 1e-3 to 1e-9 of it away from them; or on the lattice, one unit away.
void needles(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  for (int triangles = random.pick(8, 40); triangles > 0; --triangles) {
    if (random.chance(0.5)) {
      const Vector64 from = anywhere(random), to = anywhere(random);
      const double thickness = std::ldexp(kSide, -random.pick(10, 30));
      const Vector64 aside = random.direction() * thickness;
      stage.triangle({from, to, (random.chance(0.5) ? from + (to - from) * random.unit() : to) + aside});
    } else {
      const Vector64 from = cell_corner(random, {0, 0, 0}, 4 * kSide), to = cell_corner(random, {0, 0, 0}, 4 * kSide);
      stage.triangle({from, to, to + each_axis([&] { return random.pick(-1, 1); })});
    }
  }
  aim_at_surface(stage, kRays);
}

/// Without area in exact arithmetic: two vertices or all three equal, three on a line. Others among them.
void degenerate(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  for (int triangles = random.pick(8, 30); triangles > 0; --triangles) {
    const Vector64 a = point_in_block(random, {0, 0, 0}, 4 * kSide),
                   step = each_axis([&] { return random.pick(-9, 9); });
    switch (random.below(4)) {
      case 0:
        stage.triangle({a, a, a});
        break;
      case 1:
        stage.triangle({a, a + step * 64, a});
        break;
      case 2:
        stage.triangle({a, a + step * 16, a + step * 48});
        break;
      default:
        stage.triangle({a, point_in_block(random, {0, 0, 0}, 4 * kSide), point_in_block(random, {0, 0, 0}, 4 * kSide)});
    }
  }
  aim_at_surface(stage, kRays);
}

/// One to three triangles, each a thousand times: no split can part them.
void duplicates(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  for (int kinds = random.pick(1, 3); kinds > 0; --kinds) {
    const Vector64 a = cell_corner(random, {0, 0, 0}), b = cell_corner(random, {0, 0, 0}),
                   c = cell_corner(random, {0, 0, 0});
    const Vector64 at = each_axis([&] { return random.pick(0, 3); }) * kSide;
    for (int copies = random.pick(1000, 1200); copies > 0; --copies) stage.triangle({at + a, at + b, at + c});
  }
  aim_at_surface(stage, 64);
}

void soup(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  for (int triangles = random.pick(1, 60); triangles > 0; --triangles) {
    const Vector64 at = anywhere(random);
    const double size = std::ldexp(4 * kSide, -random.pick(0, 5));
    stage.triangle({at, at + random.direction() * size, at + random.direction() * size});
  }
  aim_at_surface(stage, kRays);
}

float any_finite(CaseRandom& random) {
  for (;;) {
    const float x = numeric::from_bits(random.bits());
    if (std::isfinite(x)) return x;
  }
}

/// Any bits that are a finite number, as vertices and as rays; most rays aimed at vertices.
void any_bits(CaseRandom& random, HardCase& out) {
  Stage stage(random, out);
  const auto any_point = [&] { return Vector64(Vec3{any_finite(random), any_finite(random), any_finite(random)}); };
  for (int triangles = random.pick(1, 24); triangles > 0; --triangles)
    stage.triangle({any_point(), any_point(), any_point()});
  for (int i = 0; i < kRays; ++i) {
    if (random.chance(0.2)) {
      const Vector64 origin = any_point();
      const Vec3 direction{any_finite(random), any_finite(random), any_finite(random)};
      stage.ray_along(origin, direction, std::fabs(any_finite(random)));
    } else {
      const Vector64 target = stage.surface_point();
      Vector64 origin = random.chance(0.5) ? any_point() : Vector64{};
      if (random.chance(0.3)) axis_of(origin, random.below(3)) = axis_of(target, random.below(3));
      stage.ray({origin, target, RangeMix::Any, random.one_of({0, 0, -2, -64, 64})});
    }
  }
}

constexpr Generator kGenerators[] = {
    {"needles", "triangles 1e-3 to 1e-9 as wide as long", needles},
    {"degenerate-triangles", "triangles without area among others", degenerate},
    {"duplicates", "a few triangles a thousand times each: no split parts them", duplicates},
    {"soup", "plain triangles of any place and size, to compare with", soup},
    {"any-bits", "vertices and rays of any finite bits", any_bits},
};

}  // namespace

std::span<const Generator> mesh_generators() { return kGenerators; }

}  // namespace ctu::sim::check
