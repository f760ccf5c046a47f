// Rays through the places where tests of neighbours must not both say no: vertices, shared edges, corners of cells;
// rays in the plane of a triangle; rays at a closed mesh, which cannot pass it.
#include <cmath>

#include "sim/check/generators.h"
#include "sim/check/generators/stage.h"

namespace ctu::sim::check {
namespace {

Vector64 lattice_point(CaseRandom& random) {
  return each_axis([&] { return random.below(4 * kSide + 1); });
}

/// A fan of triangles around a vertex, its rim a bent ring of lattice points.
void add_fan(Stage& stage, const Vector64& middle) {
  CaseRandom& random = stage.random();
  const int axis = random.below(3), b = (axis + 1) % 3, c = (axis + 2) % 3;
  static constexpr int kRing[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  Vector64 rim[8];
  for (int i = 0; i < 8; ++i) {
    rim[i] = middle;
    axis_of(rim[i], b) += kRing[i][0] * random.pick(1, kSide);
    axis_of(rim[i], c) += kRing[i][1] * random.pick(1, kSide);
    axis_of(rim[i], axis) += random.pick(-kSide / 4, kSide / 4);
  }
  for (int i = 0; i < 8; ++i) stage.triangle({middle, rim[i], rim[(i + 1) % 8]});
}

/// A bent sheet of n x n squares, two triangles each, across `axis`.
void add_sheet(Stage& stage, int n, int bend) {
  CaseRandom& random = stage.random();
  const int axis = random.below(3), b = (axis + 1) % 3, c = (axis + 2) % 3;
  const double pitch = 4.0 * kSide / n;
  std::vector<Vector64> points;
  const double height = random.below(4 * kSide);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      Vector64 p;
      axis_of(p, axis) = height + random.pick(-bend, bend);
      axis_of(p, b) = i * pitch;
      axis_of(p, c) = j * pitch;
      points.push_back(p);
    }
  const auto at = [&](int i, int j) { return points[static_cast<std::size_t>(i + (n + 1) * j)]; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      stage.triangle({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      stage.triangle({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

void through_vertices(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  for (int fans = random.pick(2, 5); fans > 0; --fans) add_fan(stage, lattice_point(random));
  for (int i = 0; i < kRays; ++i) {
    stage.ray({outside_point(random), stage.vertex(), RangeMix::Any, random.pick(-2, 2)});
    if (random.chance(0.15)) stage.nudge(1);
  }
}

void through_edges(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  const int squares = random.pick(2, 6);
  add_sheet(stage, squares, random.chance(0.5) ? 0 : kSide / 4);
  if (random.chance(0.5)) add_sheet(stage, 2, kSide / 4);
  for (int i = 0; i < kRays; ++i) {
    stage.ray({outside_point(random), stage.edge_point(), RangeMix::Any, random.pick(-2, 2)});
    if (random.chance(0.15)) stage.nudge(1);
  }
}

/// Struts meet their cells at corners and along edges: the ray passes where eight cells meet, in one of them at a time.
void through_cell_corners(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  const std::vector<Vector64> blocks = add_blocks(stage, 3, 14);
  for (int i = 0; i < kRays; ++i) {
    const int triangle = random.below(stage.triangles());
    const Vector64 &from = stage.corner(triangle, 0), &to = stage.corner(triangle, 1);
    const int r = random.pick(2, 8);
    const Vector64 target = from + (to - from) * random.pick(0, r) * (1.0 / r);
    // From another cell corner of some block, or from afar.
    const Vector64& block = blocks[static_cast<std::size_t>(random.below(static_cast<int>(blocks.size())))];
    const int times = random.pick(-2, 3);
    const Vector64 origin =
        random.chance(0.6) ? block + (cell_corner(random, block) - block) * times : outside_point(random);
    stage.ray({origin, target, RangeMix::Any, random.pick(-2, 2)});
    if (random.chance(0.15)) stage.nudge(1);
  }
}

/// Along edges, from vertex to vertex, in the plane of a triangle, and a little out of it.
void grazing(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  add_blocks(stage, 3, 10);
  add_sheet(stage, 2, kSide / 8);
  for (int i = 0; i < kRays; ++i) {
    const int triangle = random.below(stage.triangles()), first = random.below(3);
    const Vector64 &a = stage.corner(triangle, first), &b = stage.corner(triangle, (first + 1) % 3),
                   &c = stage.corner(triangle, (first + 2) % 3);
    const double reach = random.pick(1, 4);
    const Vector64 from = random.chance(0.5) ? a : a + (c - a) * (random.pick(0, 8) * 0.125);
    stage.ray({from - (b - from) * reach, from, RangeMix::Any, random.pick(-2, 2)});
    if (random.chance(0.5)) stage.nudge(random.chance(0.5) ? 1 : 64);
  }
}

/// An octahedron or a box on the lattice; rays from inside and from outside.
void closed_meshes(CaseRandom& random, HardCase& out) {
  Stage stage(random, out, Frame::scaled(random.pick(-12, 12)));
  const Vector64 middle = Vector64(2, 2, 2) * kSide;
  Vector64 tip[3][2];
  for (int a = 0; a < 3; ++a)
    for (int s = 0; s < 2; ++s) {
      tip[a][s] = middle;
      axis_of(tip[a][s], a) += (s == 0 ? 1 : -1) * random.pick(kSide, 2 * kSide);
    }
  for (int octant = 0; octant < 8; ++octant) {
    const Vector64 &x = tip[0][octant & 1], &y = tip[1][octant >> 1 & 1], &z = tip[2][octant >> 2];
    const Vector64 xy = Vector64((x.x + y.x) / 2, (x.y + y.y) / 2, (x.z + y.z) / 2);
    stage.triangle({x, xy, z});
    stage.triangle({y, xy, z});
  }
  for (int i = 0; i < kRays; ++i) {
    const Vector64 target = random.chance(0.4) ? stage.vertex() : stage.edge_point();
    const Vector64 inside = middle + each_axis([&] { return random.pick(-200, 200); });
    stage.ray({random.chance(0.5) ? inside : outside_point(random), target, RangeMix::Any, random.pick(-2, 2)});
    if (random.chance(0.15)) stage.nudge(1);
  }
}

constexpr Generator kGenerators[] = {
    {"through-vertices", "rays through vertices that eight triangles share", through_vertices},
    {"through-edges", "rays through shared edges of sheets", through_edges},
    {"through-cell-corners", "rays through corners of cells, where geometry passes too", through_cell_corners},
    {"grazing", "rays along edges and in the planes of triangles", grazing},
    {"closed-meshes", "rays at edges and vertices of closed meshes, from inside and outside", closed_meshes},
};

}  // namespace

std::span<const Generator> aimed_ray_generators() { return kGenerators; }

}  // namespace ctu::sim::check
