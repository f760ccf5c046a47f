#include "model/cull/cell_locate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/cull/options.h"
#include "tests/cull/cases.h"
#include "tests/cull/exact_points.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

using test::CellIndex;
using test::Family;
using test::RayAndBox;

struct Located {
  bool hit = false;
  CellKey key;
  float t0 = 0, t1 = 0;
};

Located locate(const RayAndBox& c, int ray_resolution) {
  const intersect::PreparedRay ray = intersect::prepare_ray(c.ray);
  if (!ray.valid) return {};
  const intersect::Box4 boxes = test::box_in_lane_0(c.lo, c.hi);
  const intersect::SlabTimes times = intersect::slab_test(ray, boxes, c.ray.tmax);
  if ((times.hit & 1) == 0) return {};
  return {true, cell_locate(ray, times, boxes, 0, ray_resolution), times.t0[0], times.t1[0]};
}

CellIndex begin_of(CellKey key) { return {{key.begin(0), key.begin(1), key.begin(2)}}; }
CellIndex end_of(CellKey key) { return {{key.end(0), key.end(1), key.end(2)}}; }

class CellLocate : public testing::TestWithParam<Family> {};

TEST_P(CellLocate, a_certain_key_names_the_floor_cells_of_the_exact_first_and_last_point_or_a_column_with_both) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed());
  int asked = 0, uncertain = 0, named = 0, columns = 0;
  for (int i = 0; i < 3000; ++i) {
    const RayAndBox c = make.ray_and_box(GetParam());
    const int resolution = make.integer(kMinResolution, kMaxRayResolution);
    const Located located = locate(c, resolution);
    if (!located.hit) continue;
    ++asked;
    uncertain += located.key.uncertain();
    if (located.key.uncertain()) continue;
    const test::ExactOverlap exact = test::exact_overlap_cells(c.ray, c.lo, c.hi, resolution, c.ray.tmin, c.ray.tmax);
    if (exact.hit) {
      ASSERT_TRUE(test::holds(located.key, exact.begin, exact.end)) << "R_ray " << resolution << ": " << test::text(c);
      named += begin_of(located.key) == exact.begin && end_of(located.key) == exact.end;
      columns += !(begin_of(located.key) == exact.begin && end_of(located.key) == exact.end);
    }
    // And of the points at the slab test's own times, which may lie outside the box.
    if (!std::isfinite(located.t0) || !std::isfinite(located.t1)) continue;
    ASSERT_TRUE(test::holds(located.key, test::exact_cell_at(c.ray, c.lo, c.hi, resolution, located.t0),
                            test::exact_cell_at(c.ray, c.lo, c.hi, resolution, located.t1)))
        << test::text(c);
  }
  RecordProperty("exact_cells_named", named);
  RecordProperty("columns", columns);
  RecordProperty("boxes_hit", asked);
  RecordProperty("uncertain", uncertain);
  EXPECT_GT(asked, 300);
}

INSTANTIATE_TEST_SUITE_P(Families, CellLocate, testing::ValuesIn(test::families()),
                         [](const auto& info) { return test::identifier(info.param); });

TEST(CellLocateExamples, near_boxes_leave_hardly_a_key_uncertain) {
  test::CaseMaker make(7);
  const Family near{.name = "near"};
  int asked = 0, uncertain = 0;
  for (int i = 0; i < 200000; ++i) {
    RayAndBox c;
    make.box(near, c.lo, c.hi);
    // Aimed at no special point.
    const Vec3 target{make.uniform(c.lo.x, c.hi.x), make.uniform(c.lo.y, c.hi.y), make.uniform(c.lo.z, c.hi.z)};
    c.ray = make.ray_to(near, c.lo, c.hi, target);
    const Located located = locate(c, 4);
    asked += located.hit;
    uncertain += located.hit && located.key.uncertain();
  }
  RecordProperty("uncertain_per_million", static_cast<int>(1e6 * uncertain / asked));
  EXPECT_LT(uncertain, asked / 10000);
}

TEST(CellLocateExamples, given_a_ray_that_enters_on_a_cell_border_exactly_then_the_upper_cell_is_named) {
  // The times are exact here: powers of two throughout.
  const Located up = locate({{{-1, 2, 2}, 0, {1, 0, 0}, 100}, {0, 0, 0}, {4, 4, 4}}, 4);
  ASSERT_TRUE(up.hit);
  ASSERT_FALSE(up.key.uncertain());
  EXPECT_EQ(begin_of(up.key), (CellIndex{{0, 2, 2}}));
  EXPECT_EQ(end_of(up.key), (CellIndex{{3, 2, 2}}));
}

TEST(CellLocateExamples, given_a_ray_that_ends_on_a_cell_border_then_both_directions_name_its_floor_cell) {
  const Located up = locate({{{0, 0.5f, 0.5f}, 0, {1, 0, 0}, 2}, {0, 0, 0}, {4, 4, 4}}, 4);
  const Located down = locate({{{4, 0.5f, 0.5f}, 0, {-1, 0, 0}, 2}, {0, 0, 0}, {4, 4, 4}}, 4);
  ASSERT_FALSE(up.key.uncertain());
  ASSERT_FALSE(down.key.uncertain());
  EXPECT_EQ(up.key.end(0), 2);
  EXPECT_EQ(down.key.begin(0), 3);
  EXPECT_EQ(down.key.end(0), 2);
}

TEST(CellLocateExamples, a_box_one_place_thick_gets_a_column_through_its_thickness) {
  const float lo = 15.653308f, hi = std::nextafter(lo, 100.0f);
  const Located through = locate({{{0.3f, 0.4f, -50}, 0, {0.001f, 0.002f, 1}, 99}, {0, 0, lo}, {4, 4, hi}}, 4);
  ASSERT_TRUE(through.hit);
  ASSERT_FALSE(through.key.uncertain());
  EXPECT_EQ(begin_of(through.key), (CellIndex{{0, 0, 0}}));
  EXPECT_EQ(end_of(through.key), (CellIndex{{0, 0, 3}}));
}

TEST(CellLocateExamples, a_flat_axis_names_cell_zero_and_is_never_uncertain) {
  const Located across = locate({{{0.3f, 0.4f, -1}, 0, {0.01f, 0.02f, 1}, 9}, {0, 0, 1}, {1, 1, 1}}, 4);
  ASSERT_TRUE(across.hit);
  EXPECT_FALSE(across.key.uncertain());
  EXPECT_EQ(across.key.begin(2), 0);
  EXPECT_EQ(across.key.end(2), 0);
}

}  // namespace
}  // namespace ctu::cull
