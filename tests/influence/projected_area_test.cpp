// A projected area is the share of affine rays that visit the box: closed forms, and counted rays.
#include "model/influence/projected_area.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/intersect/slab_test.h"
#include "tests/influence/random_areas.h"
#include "tests/oracle/seed.h"

namespace ctu {
namespace {

using influence::AreaKind;
using influence::InfluenceArea;
using influence::ProjectedArea;

InfluenceArea aligned(AreaKind kind, float half, float near, float far) {
  InfluenceArea area;
  area.kind = kind;
  area.axes = influence::frame_along({0, 0, 1}, {1, 0, 0});
  area.half_x = area.half_y = half;
  area.near = near;
  area.far = far;
  return area;
}

/// The point of the area at the place (x, y) of its cross-section, -1 to 1, and the distance z along its rays.
Vec3 point_at(const InfluenceArea& area, double x, double y, double z) {
  const double scale = area.kind == AreaKind::Point ? z : 1;
  const double q[3] = {x * area.half_x * scale, y * area.half_y * scale, z};
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    double sum = area.origin[axis];
    for (int i = 0; i < 3; ++i) sum += q[i] * area.axes[i][axis];  // orthonormal: the inverse is the transpose
    p[axis] = static_cast<float>(sum);
  }
  return p;
}

/// The share of a lattice of rays, each from end to end of the area, that visit the box.
double counted_share(const InfluenceArea& area, const Vec3& lower, const Vec3& upper, int side) {
  int visits = 0;
  for (int i = 0; i < side * side; ++i) {
    const double x = (2 * (i % side) + 1.0) / side - 1, y = (2 * (i / side) + 1.0) / side - 1;
    const Vec3 from = point_at(area, x, y, area.near), to = point_at(area, x, y, area.far);
    const intersect::Ray ray{from, 0, {to.x - from.x, to.y - from.y, to.z - from.z}, 1};
    intersect::Box4 boxes;
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        boxes.lo[axis][lane] = lower[axis];
        boxes.hi[axis][lane] = upper[axis];
      }
    visits += intersect::slab_test(intersect::prepare_ray(ray), boxes, ray.tmax).hit & 1;
  }
  return double(visits) / (side * side);
}

TEST(ProjectedArea, along_an_axis_is_the_face_of_the_box) {
  const ProjectedArea chance(aligned(AreaKind::Plane, 2, 0, 10));
  EXPECT_DOUBLE_EQ(chance.share({-1, -1, 3}, {1, 0, 9}), 2.0 / 16);
  EXPECT_DOUBLE_EQ(chance.share({-1, -1, -9}, {1, 0, 99}), 2.0 / 16) << "its depth does not matter";
  EXPECT_DOUBLE_EQ(chance.share({1, 1, 3}, {9, 9, 4}), 1.0 / 16) << "cut to the cross-section";
  EXPECT_DOUBLE_EQ(chance.share({-9, -9, -9}, {9, 9, 19}), 1);
  EXPECT_EQ(chance.share({-1, -1, 11}, {1, 1, 12}), 0) << "behind the end";
  EXPECT_EQ(chance.share({3, -1, 3}, {4, 1, 4}), 0) << "beside";
  EXPECT_EQ(chance.share({0, -1, 3}, {0, 1, 4}), 0) << "edge-on";
}

TEST(ProjectedArea, of_a_turned_box_is_the_sum_of_its_faces_times_their_facing) {
  InfluenceArea area = aligned(AreaKind::Plane, 10, -10, 10);
  const Vec3 direction{1, 2, 3};
  area.axes = influence::frame_along(direction, {0, 1, 0});
  const double length = std::sqrt(14.0);  // Cauchy: each face's area times the direction's component across it
  EXPECT_NEAR(ProjectedArea(area).share({-1, -1, 0}, {1, 0, 2}), (1 * 2 + 2 * 4 + 3 * 2) / length / 400, 1e-7);
  EXPECT_NEAR(ProjectedArea(area).share({-1, -1, 0}, {0, 1, 3}), (1 * 6 + 2 * 3 + 3 * 2) / length / 400, 1e-7);
}

TEST(ProjectedArea, in_perspective_shrinks_with_the_square_of_the_distance) {
  const ProjectedArea chance(aligned(AreaKind::Point, 1, 1, 100));
  EXPECT_NEAR(chance.share({-1, -1, 10}, {1, 1, 10}), 0.01, 1e-12);
  EXPECT_NEAR(chance.share({-1, -1, 20}, {1, 1, 20}), 0.0025, 1e-12);
  EXPECT_NEAR(chance.share({-1, -1, 10}, {1, 1, 20}), 0.01, 1e-12) << "the near face covers the far one";
  EXPECT_NEAR(chance.share({-0.5f, -0.5f, -7}, {0.5f, 0.5f, 20}), 0.25, 1e-12) << "cut at the near end";
}

TEST(ProjectedArea, is_the_share_of_the_rays_that_visit) {
  SCOPED_TRACE(oracle::seed_note());
  test::AreaRandom random(oracle::test_seed() + 5);
  constexpr int kSide = 96;
  int partly = 0;
  for (int i = 0; i < 200; ++i) {
    const InfluenceArea area = random.area(1, 1);
    const Vec3 middle =
        point_at(area, random.between(-1, 1), random.between(-1, 1), random.between(area.near, area.far));
    Vec3 lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = middle[axis] - random.between(0, 0.4f);
      upper[axis] = middle[axis] + random.between(0, 0.4f);
    }
    const double share = ProjectedArea(area).share(lower, upper);
    partly += share > 0.05 && share < 0.95 ? 1 : 0;
    // A convex outline crosses at most 4 kSide cells of the lattice.
    EXPECT_NEAR(share, counted_share(area, lower, upper, kSide), 4.0 / kSide) << "case " << i;
  }
  EXPECT_GT(partly, 60);
}

TEST(ProjectedArea, of_scaled_boxes_is_the_same) {
  test::AreaRandom random(oracle::test_seed() + 6);
  const InfluenceArea area = random.area(1, 1);
  const Vec3 o = point_at(area, 0, 0, area.far);
  const accel::Box3 box{accel::to_vector({o.x - 0.25f, o.y - 0.25f, o.z - 0.5f}),
                        accel::to_vector({o.x + 0.25f, o.y + 0.5f, o.z + 0.25f})};
  const __m128 factor = _mm_set1_ps(0x1p-7f);
  const accel::Box3 scaled{_mm_mul_ps(box.lower, factor), _mm_mul_ps(box.upper, factor)};
  EXPECT_GT(ProjectedArea(area)(box), 0);
  EXPECT_NEAR(ProjectedArea(area)(box), ProjectedArea(area, 0x1p-7)(scaled), 1e-6);
}

}  // namespace
}  // namespace ctu
