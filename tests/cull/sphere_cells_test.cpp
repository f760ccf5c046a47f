// Voxelized spheres against exact arithmetic: distances of a cell's nearest and farthest points, squared, in rationals.
#include "model/cull/sphere_cells.h"

#include <gtest/gtest.h>

#include "model/accel/build.h"
#include "model/cull/object_masks.h"
#include "tests/cull/cases.h"
#include "tests/oracle/rational.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

using oracle::exact;
using oracle::Rational;

/// Whether the closed cell [lo, hi] has a point of the surface.
bool exactly_touched(const Vec3& lo, const Vec3& hi, int resolution, const int (&cell)[3], const scene::Sphere& s) {
  Rational least = 0, most = 0;
  for (int a = 0; a < 3; ++a) {
    const Rational size = exact(hi[a]) - exact(lo[a]);
    Rational low = exact(lo[a]) + size * cell[a] / resolution - exact(s.centre[a]);
    Rational high = exact(lo[a]) + size * (cell[a] + 1) / resolution - exact(s.centre[a]);
    const Rational near = low > 0 ? low : high < 0 ? Rational(-high) : Rational(0);
    const Rational far = -low > high ? Rational(-low) : high;
    least += near * near;
    most += far * far;
  }
  const Rational square = exact(s.radius) * exact(s.radius);
  return least <= square && square <= most;
}

TEST(SphereCells, every_touched_cell_is_marked_and_practically_no_other) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed());
  int marked = 0, touched = 0;
  for (const test::Family& family : test::families())
    for (int i = 0; i < 40; ++i) {
      Vec3 lo, hi, v[3];
      make.box(family, lo, hi);
      make.triangle(family, lo, hi, v);  // the first two are the centre and a point of the surface, about
      double square = 0;
      for (int a = 0; a < 3; ++a) square += (double{v[0][a]} - v[1][a]) * (double{v[0][a]} - v[1][a]);
      const scene::Sphere sphere{v[0], static_cast<float>(std::sqrt(square))};
      if (!std::isfinite(lower_corner(sphere).x) || !std::isfinite(upper_corner(sphere).x)) continue;
      std::uint64_t mask[kWords<4>] = {};
      add_sphere<4>({lo, hi}, sphere, mask);
      for (int c = 0; c < 64; ++c) {
        const int cell[3] = {c % 4, c / 4 % 4, c / 16};
        const bool should = exactly_touched(lo, hi, 4, cell, sphere), is = (mask[0] >> c & 1) != 0;
        ASSERT_TRUE(is || !should) << "cell " << c << ", box " << test::text(lo) << test::text(hi) << ", sphere "
                                   << test::text(sphere.centre) << sphere.radius;
        marked += is;
        touched += should;
      }
    }
  EXPECT_GT(touched, 10'000);
  EXPECT_LE(marked, touched + touched / 200);
}

TEST(SphereCells, the_inside_of_a_ball_is_not_occupied) {
  std::uint64_t mask[kWords<8>] = {};
  add_sphere<8>({{-1, -1, -1}, {1, 1, 1}}, {{0, 0, 0}, 1}, mask);
  EXPECT_EQ(mask[3] >> (3 + 8 * 3) & 1, 0u);  // cell (3, 3, 3) ends at the centre
  EXPECT_EQ(mask[0] & 1, 0u);                 // a corner of the box is outside
  EXPECT_EQ(mask[3] >> (8 * 3) & 1, 1u);      // cell (0, 3, 3)
}

TEST(SphereCells, masks_of_a_tree_hold_its_spheres) {
  scene::Mesh mesh;
  mesh.spheres = {{{0, 0, 0}, 1}, {{3, 0, 0}, 0.25f}, {{0, 3, 1}, 0.5f}};
  const accel::Bvh4 bvh = accel::build(mesh, {});
  const ObjectMasks masks = build_object_masks(bvh, {.resolution = 4}, 1);
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    if (bvh.nodes[0].child[lane] == accel::kEmptyChild) continue;
    std::uint64_t expected[1] = {};
    Bounds box;
    for (int a = 0; a < 3; ++a)
      box.lower[a] = bvh.nodes[0].boxes.lo[a][lane], box.upper[a] = bvh.nodes[0].boxes.hi[a][lane];
    for (int i = 0; i < accel::leaf_count(bvh.nodes[0].child[lane]); ++i)
      add_sphere<4>(box, bvh.triangles[accel::leaf_first(bvh.nodes[0].child[lane]) + static_cast<unsigned>(i)].sphere(),
                    expected);
    EXPECT_EQ(*masks.mask(0, lane), expected[0]);
    EXPECT_NE(expected[0], 0u);
  }
}

}  // namespace
}  // namespace ctu::cull
