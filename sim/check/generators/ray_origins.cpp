// Where rays begin: on the faces, edges and corners of the boxes they are asked of, on borders of their cells, inside,
// on the geometry itself, and so far away that a box is a few units in the last place of the distance.
#include <cmath>

#include "sim/check/generators.h"
#include "sim/check/generators/stage.h"

namespace ctu::sim::check {
namespace {

/// Rays from `origin_of(block)` to points of the geometry; now and then with a component that is zero.
template <class OriginOf>
void rays_from(CaseRandom& random, HardCase& out, OriginOf&& origin_of) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  const std::vector<Vector64> blocks = add_blocks(stage, 3, 14);
  for (int i = 0; i < kRays; ++i) {
    const Vector64 origin =
        origin_of(stage, blocks[static_cast<std::size_t>(random.below(static_cast<int>(blocks.size())))]);
    const Vector64 target = stage.surface_point();
    const int exponent = random.pick(-2, 2);
    if (!random.chance(0.25)) {
      stage.ray({origin, target, RangeMix::Any, exponent});
      continue;
    }
    // In a plane of the origin: the ray runs along a face, edge or border.
    Vector64 in_plane = origin;
    axis_of(in_plane, random.below(3)) = axis_of(target, random.below(3));
    stage.ray({in_plane, target, RangeMix::Any, exponent});
  }
}

/// A point of the block with `fixed` of its coordinates on faces.
Vector64 on_faces(CaseRandom& random, const Vector64& block, int fixed) {
  Vector64 point = point_in_block(random, block);
  const int first = random.below(3);
  for (int i = 0; i < fixed; ++i) {
    const int axis = (first + i) % 3;
    axis_of(point, axis) = axis_of(block, axis) + (random.chance(0.5) ? kSide : 0);
  }
  return point;
}

void on_box_faces(CaseRandom& random, HardCase& out) {
  rays_from(random, out, [&](Stage&, const Vector64& block) { return on_faces(random, block, 1); });
}

void on_box_edges(CaseRandom& random, HardCase& out) {
  rays_from(random, out, [&](Stage&, const Vector64& block) { return on_faces(random, block, 2); });
}

void on_box_corners(CaseRandom& random, HardCase& out) {
  rays_from(random, out, [&](Stage&, const Vector64& block) { return on_faces(random, block, 3); });
}

void on_cell_borders(CaseRandom& random, HardCase& out) {
  rays_from(random, out, [&](Stage&, const Vector64& block) {
    const Vector64 corner = cell_corner(random, block);
    Vector64 point = point_in_block(random, block);
    const int first = random.below(3), fixed = random.pick(1, 3);
    for (int i = 0; i < fixed; ++i) axis_of(point, (first + i) % 3) = axis_of(corner, (first + i) % 3);
    return point;
  });
}

void inside_boxes(CaseRandom& random, HardCase& out) {
  rays_from(random, out,
            [&](Stage&, const Vector64& block) { return block + each_axis([&] { return random.unit(); }) * kSide; });
}

void on_geometry(CaseRandom& random, HardCase& out) {
  rays_from(random, out, [&](Stage& stage, const Vector64&) { return stage.surface_point(); });
}

/// From 2^low to 2^high block sizes away, about 1e3 to 1e12: mostly along one axis, drifting by some blocks on the way;
/// or through the lattice's zero point, which such rays pass exactly.
void far_away(CaseRandom& random, HardCase& out) {
  constexpr int kLow = 10, kHigh = 40;
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_blocks(stage, 3, 14);
  stage.triangle({{0, 0, 0}, {kSide, 0, 0}, {0, kSide, kSide}});
  for (int i = 0; i < kRays; ++i) {
    const int sizes = random.pick(kLow, kHigh);
    const double distance = std::ldexp(kSide, sizes);
    if (random.chance(0.3)) {
      stage.ray({random.direction() * distance, {0, 0, 0}, RangeMix::Any, -sizes});
      continue;
    }
    const int axis = random.below(3);
    const Vector64 target = stage.surface_point();
    Vector64 origin = target;
    for (int a = 0; a < 3; ++a) axis_of(origin, a) += random.pick(-2, 2) * kSide;
    axis_of(origin, axis) = random.either_sign(distance);
    stage.ray({origin, target, RangeMix::Any, random.chance(0.5) ? -sizes : 0});
  }
}

/// A scene of some units, long on some axes, seen from as far as binary32 can tell a unit apart, and farther.
/// Components of directions are small integers, some of them powers of two: times are sharp on those axes, and whole
/// cells uncertain on the others.
void far_and_exact(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-60, 60)));
  const Vector64 widths = each_axis([&] { return 1 << random.pick(1, 7); });
  const auto lattice_point = [&] {
    Vector64 point;
    for (int a = 0; a < 3; ++a) axis_of(point, a) = random.pick(0, static_cast<int>(axis_of(widths, a)));
    return point;
  };
  for (int triangles = random.pick(6, 40); triangles > 0; --triangles) {
    const Vector64 at = lattice_point();
    stage.triangle({at + lattice_point(), at + lattice_point(), at + lattice_point()});
  }
  for (int i = 0; i < kRays; ++i) {
    const int bits = random.pick(0, 10);
    const auto component = [&]() -> double {
      const double size = random.chance(0.4) ? 1 << random.pick(0, bits) : random.pick(0, 1 << bits);
      return random.either_sign(size);
    };
    const Vector64 target = stage.surface_point();
    const double time = std::ldexp(1.0, random.pick(18, 26) - bits);
    stage.ray({target - each_axis(component) * time, target, RangeMix::Any, random.pick(-30, 2)});
  }
}

constexpr Generator kGenerators[] = {
    {"origins-on-faces", "origins on the faces of boxes", on_box_faces},
    {"origins-on-edges", "origins on the edges of boxes", on_box_edges},
    {"origins-on-corners", "origins on the corners of boxes", on_box_corners},
    {"origins-on-cell-borders", "origins on borders of the cells for R from 2 to 8", on_cell_borders},
    {"origins-inside", "origins inside of boxes", inside_boxes},
    {"origins-on-geometry", "origins on vertices, edges and faces of triangles", on_geometry},
    {"origins-far-away", "origins 1e3 to 1e12 box sizes away", far_away},
    {"far-and-exact", "far rays whose times are exact on some axes and rounded on others", far_and_exact},
};

}  // namespace

std::span<const Generator> ray_origin_generators() { return kGenerators; }

}  // namespace ctu::sim::check
