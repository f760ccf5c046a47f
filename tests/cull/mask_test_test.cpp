// Contract 1 for the mask test: no design rejects a box that holds something the ray meets.
#include "model/cull/mask_test.h"

#include <gtest/gtest.h>

#include "model/cull/mask_words.h"
#include "tests/cull/cases.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

using test::Family;

/// Testers of every design for every R, with key resolutions that divide R, are divided by it, and neither.
const std::vector<MaskTester>& testers() {
  static const std::vector<MaskTester> all = [] {
    std::vector<MaskTester> made;
    for (int r = kMinResolution; r <= kMaxResolution; ++r) {
      for (const Design design : {Design::None, Design::Ideal, Design::Comparators})
        made.emplace_back(design, MaskOptions{.resolution = r, .ray_resolution = r});
      // Tables by the whole key where they are small, R_ray = 3R and non-multiples among them.
      for (int ray_resolution = r; ray_resolution <= std::min(3 * r, 7); ++ray_resolution)
        made.emplace_back(ray_resolution % 2 == 0 ? Design::MaskLut : Design::Dedup,
                          MaskOptions{.resolution = r, .ray_resolution = ray_resolution});
      if (r == 8) made.emplace_back(Design::MaskLut, MaskOptions{.resolution = r, .ray_resolution = r});
      for (int ray_resolution = r; ray_resolution <= 3 * r; ++ray_resolution)
        made.emplace_back(Design::Projection, MaskOptions{.resolution = r, .ray_resolution = ray_resolution});
    }
    return made;
  }();
  return all;
}

class MaskTest : public testing::TestWithParam<Family> {};

TEST_P(MaskTest, culling_keeps_every_true_hit) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed());
  int hits = 0, passes = 0, asked = 0;
  for (int i = 0; i < 250; ++i) {
    Vec3 lo, hi, v[3];
    make.box(GetParam(), lo, hi);
    make.triangle(GetParam(), lo, hi, v);
    const accel::Bvh4 bvh = test::one_leaf({{v[0], v[1], v[2], 0}});
    std::vector<ObjectMasks> masks(kMaxResolution + 1);
    for (int r = kMinResolution; r <= kMaxResolution; ++r)
      masks[static_cast<std::size_t>(r)] = build_object_masks(bvh, {.resolution = r}, 1);
    for (int j = 0; j < 6; ++j) {
      const test::RayAndBox c{make.ray_to(GetParam(), bvh.lower, bvh.upper, make.point_of(v)), bvh.lower, bvh.upper};
      const intersect::PreparedRay ray = intersect::prepare_ray(c.ray);
      if (!ray.valid) continue;
      const bool hit = oracle::exact_ray_triangle(c.ray, v[0], v[1], v[2], c.ray.tmin, c.ray.tmax).hit;
      hits += hit;
      const intersect::Box4& boxes = bvh.nodes[0].boxes;
      const intersect::SlabTimes times = intersect::slab_test(ray, boxes, c.ray.tmax);
      for (const MaskTester& tester : testers()) {
        const int r = tester.options().resolution;
        const MaskTestResult result = tester.test(ray, times, boxes, masks[static_cast<std::size_t>(r)].of(0));
        ASSERT_EQ(result.pass & ~times.hit, 0);
        ASSERT_EQ(result.uncertain & ~result.pass, 0);
        ++asked;
        passes += result.pass & 1;
        if (!hit) continue;
        ASSERT_EQ(result.pass & 1, 1) << to_string(tester.design()) << ", R " << r << ", R_ray "
                                      << tester.options().ray_resolution << ": " << test::text(c) << ", triangle "
                                      << test::text(v[0]) << test::text(v[1]) << test::text(v[2]);
      }
    }
  }
  RecordProperty("exact_hits", hits);
  RecordProperty("asked", asked);
  RecordProperty("passes", passes);
}

TEST_P(MaskTest, projection_answers_as_the_table_and_the_untabled_designs_are_ordered) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed() + 2);
  const MaskTester table(Design::MaskLut, {.resolution = 4, .ray_resolution = 6});
  const MaskTester projection(Design::Projection, {.resolution = 4, .ray_resolution = 6});
  const MaskTester comparators(Design::Comparators, {}), ideal(Design::Ideal, {}), none(Design::None, {});
  for (int i = 0; i < 2000; ++i) {
    const test::RayAndBox c = make.ray_and_box(GetParam());
    const intersect::PreparedRay ray = intersect::prepare_ray(c.ray);
    if (!ray.valid) continue;
    const intersect::Box4 boxes = test::box_in_lane_0(c.lo, c.hi);
    const intersect::SlabTimes times = intersect::slab_test(ray, boxes, c.ray.tmax);
    const std::uint64_t objects[4] = {std::uint64_t{1} << make.integer(0, 63) | std::uint64_t{1}
                                                                                    << make.integer(0, 63)};
    const MaskTestResult by_table = table.test(ray, times, boxes, {objects});
    const MaskTestResult by_projection = projection.test(ray, times, boxes, {objects});
    ASSERT_EQ(by_table.pass, by_projection.pass) << test::text(c);
    ASSERT_EQ(by_table.uncertain, by_projection.uncertain) << test::text(c);
    ASSERT_EQ(by_table.key[0], by_projection.key[0]) << test::text(c);
    ASSERT_EQ(ideal.test(ray, times, boxes, {objects}).pass & ~comparators.test(ray, times, boxes, {objects}).pass, 0)
        << test::text(c);
    ASSERT_EQ(none.test(ray, times, boxes, {objects}).pass, times.hit);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, MaskTest, testing::ValuesIn(test::families()),
                         [](const auto& info) { return test::identifier(info.param); });

TEST(MaskTester, answers_lanes_that_were_hit_and_no_others) {
  // Two equal boxes in lanes 0 and 2; lane 0's mask is off the ray's way, lane 2's on it.
  intersect::Box4 boxes = test::box_in_lane_0({0, 0, 0}, {4, 4, 4});
  for (int a = 0; a < 3; ++a) {
    boxes.lo[a][2] = 0;
    boxes.hi[a][2] = 4;
  }
  const intersect::PreparedRay ray = intersect::prepare_ray({{-1, 0.5f, 0.5f}, 0, {1, 0, 0}, 100});
  const intersect::SlabTimes times = intersect::slab_test(ray, boxes, 100);
  ASSERT_EQ(times.hit, 0b101);
  const std::uint64_t masks[4] = {std::uint64_t{1} << cell_bit(4, 2, 3, 3), ~std::uint64_t{0},
                                  std::uint64_t{1} << cell_bit(4, 2, 0, 0), ~std::uint64_t{0}};
  for (const Design design : {Design::Ideal, Design::MaskLut, Design::Projection, Design::Comparators}) {
    const MaskTester tester(design, {});
    EXPECT_EQ(tester.test(ray, times, boxes, {masks}).pass, 0b100) << to_string(design);
  }
}

TEST(MaskTester, passes_lanes_with_full_masks_unasked) {
  // Full masks with an own number of bits in the last word, for a key that would be uncertain (far off) or not zero.
  for (const test::Family& family : test::families()) {
    test::CaseMaker make(3);
    for (int i = 0; i < 50; ++i) {
      const test::RayAndBox c = make.ray_and_box(family);
      const int r = make.integer(kMinResolution, kMaxResolution);
      const std::vector<std::uint64_t> full = full_mask(r);
      std::vector<std::uint64_t> objects(4 * full.size());
      std::copy(full.begin(), full.end(), objects.begin());
      ASSERT_EQ(full_lanes(objects.data(), r), 1u);
      const intersect::PreparedRay ray = intersect::prepare_ray(c.ray);
      if (!ray.valid) continue;
      const intersect::Box4 boxes = test::box_in_lane_0(c.lo, c.hi);
      const intersect::SlabTimes times = intersect::slab_test(ray, boxes, c.ray.tmax);
      for (const Design design : {Design::Ideal, Design::Projection, Design::Comparators}) {
        const MaskTester tester(design, {.resolution = r, .ray_resolution = r});
        const MaskTestResult result = tester.test(ray, times, boxes, {objects.data()});
        ASSERT_EQ(result.pass, times.hit) << to_string(design) << ", R " << r << ": " << test::text(c);
        ASSERT_EQ(result.uncertain, 0);
        ASSERT_EQ(result.key[0], 0u);
      }
    }
  }
}

TEST(MaskTester, has_the_tables_of_its_design_alone) {
  EXPECT_NE(MaskTester(Design::MaskLut, {}).ray_mask_table(), nullptr);
  EXPECT_EQ(MaskTester(Design::MaskLut, {}).projection_table(), nullptr);
  EXPECT_NE(MaskTester(Design::Projection, {}).projection_table(), nullptr);
  EXPECT_EQ(MaskTester(Design::Comparators, {}).ray_mask_table(), nullptr);
}

}  // namespace
}  // namespace ctu::cull
