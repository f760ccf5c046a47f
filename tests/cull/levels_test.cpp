// Object masks from nodes L levels below (Algorithm 2).
#include <gtest/gtest.h>

#include <bit>

#include "model/accel/build.h"
#include "model/cull/fill_pattern.h"
#include "model/cull/object_masks.h"
#include "tests/cull/cases.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

enum class Shape { Random, Lattice, Thin };

scene::Mesh make_mesh(Shape shape, int triangles, std::uint64_t seed) {
  test::CaseMaker make(seed);
  scene::Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    Vec3 v[3];
    if (shape == Shape::Lattice) {
      for (Vec3& p : v)
        p = {static_cast<float>(make.integer(0, 16)), static_cast<float>(make.integer(0, 16)),
             static_cast<float>(make.integer(0, 16))};
    } else {
      const float size = shape == Shape::Thin ? 0.2f : 0.05f;
      v[0] = {make.uniform(0, 1), make.uniform(0, 1), make.uniform(0, 1)};
      for (int a = 0; a < 3; ++a) {
        v[1][a] = v[0][a] + make.uniform(-size, size);
        v[2][a] = (shape == Shape::Thin ? v[1][a] : v[0][a]) + make.uniform(-0.005f, 0.005f);
      }
    }
    mesh.vertices.insert(mesh.vertices.end(), v, v + 3);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

class Levels : public testing::TestWithParam<Shape> {
 protected:
  static bool contains(const ObjectMasks& larger, const ObjectMasks& smaller) {
    for (std::size_t i = 0; i < larger.bits.size(); ++i)
      if ((smaller.bits[i] & ~larger.bits[i]) != 0) return false;
    return true;
  }
  static std::size_t cells(const ObjectMasks& masks) {
    std::size_t n = 0;
    for (const std::uint64_t word : masks.bits) n += static_cast<std::size_t>(std::popcount(word));
    return n;
  }
};

TEST_P(Levels, masks_of_any_l_hold_those_from_all_triangles) {
  SCOPED_TRACE(oracle::seed_note());
  const accel::Bvh4 bvh = accel::build(make_mesh(GetParam(), 1500, oracle::test_seed()), {});
  for (int r = kMinResolution; r <= kMaxResolution; ++r) {
    const ObjectMasks tight = build_object_masks(bvh, {.resolution = r}, 2);
    for (int levels = 1; levels <= 5; ++levels)
      ASSERT_TRUE(contains(build_object_masks(bvh, {.resolution = r, .levels = levels}, 2), tight))
          << "R " << r << ", L " << levels;
  }
}

// Each level at which a mask is rounded to a grid in between costs cells. The levels of 2 L are among those of L; the
// levels of L + 1 are not, so from L to L + 1 only the sum is expected to shrink.
TEST_P(Levels, masks_of_twice_the_l_are_within_those_of_l) {
  SCOPED_TRACE(oracle::seed_note());
  const accel::Bvh4 bvh = accel::build(make_mesh(GetParam(), 1500, oracle::test_seed()), {});
  for (const int r : {2, 4, 5, 8}) {
    std::vector<ObjectMasks> by_level(7);
    for (int levels = 1; levels <= 6; ++levels)
      by_level[static_cast<std::size_t>(levels)] = build_object_masks(bvh, {.resolution = r, .levels = levels}, 1);
    for (const auto& [few, many] : {std::pair{1, 2}, {1, 3}, {1, 4}, {1, 5}, {2, 4}, {2, 6}, {3, 6}})
      ASSERT_TRUE(contains(by_level[static_cast<std::size_t>(few)], by_level[static_cast<std::size_t>(many)]))
          << "R " << r << ", L " << few << " and " << many;
    for (int levels = 1; levels < 5; ++levels)
      EXPECT_LE(cells(by_level[static_cast<std::size_t>(levels + 1)]),
                cells(by_level[static_cast<std::size_t>(levels)]))
          << "R " << r << ", L " << levels;
  }
}

TEST_P(Levels, an_l_deeper_than_the_tree_takes_every_triangle) {
  const accel::Bvh4 bvh = accel::build(make_mesh(GetParam(), 500, 3), {});
  EXPECT_EQ(build_object_masks(bvh, {.levels = kMaxLevels}, 1).bits, build_object_masks(bvh, {}, 1).bits);
}

// Large enough for the tree to be cut: boxes above the cut are finished after the tasks.
TEST_P(Levels, masks_of_a_tree_cut_for_threads_are_conservative_and_do_not_depend_on_their_number) {
  const accel::Bvh4 bvh = accel::build(make_mesh(GetParam(), 12000, 4), {});
  for (const int r : {4, 6}) {
    const ObjectMasks tight = build_object_masks(bvh, {.resolution = r}, 1);
    for (const int levels : {kUnlimitedLevels, 1, 2, 3}) {
      const MaskOptions options{.resolution = r, .levels = levels};
      const ObjectMasks one = build_object_masks(bvh, options, 1);
      ASSERT_TRUE(contains(one, tight)) << "R " << r << ", L " << levels;
      for (const int threads : {2, 7})
        ASSERT_EQ(build_object_masks(bvh, options, threads).bits, one.bits) << "R " << r << ", L " << levels;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Levels, testing::Values(Shape::Random, Shape::Lattice, Shape::Thin),
                         [](const auto& info) {
                           return info.param == Shape::Random ? "random"
                                  : info.param == Shape::Thin ? "thin"
                                                              : "lattice";
                         });

// Algorithm 2 as printed takes floor(R (border - lower) / extent) for the upper border too, which fills a
// neighbour wherever borders coincide; exact comparison does not.
TEST(FillPattern, given_a_child_with_its_parents_box_then_its_mask_is_copied) {
  const Bounds box{{0.1f, -3, 7}, {0.7f, 5, 7.3f}};
  const std::uint64_t child = 0x8001'0420'0000'0011u;
  std::uint64_t mask = 0;
  fill_from<4>(BoxGrid<4>(box), box, &mask, box, &child);
  EXPECT_EQ(mask, child);
}

TEST(FillPattern, given_a_child_that_is_an_octant_then_its_cells_fill_the_cells_that_hold_them) {
  // Child cells 0, 1 lie in parent cell 2 and cells 2, 3 in parent cell 3, on each axis; the child's lower faces lie on
  // a border, so its first cells touch parent cell 1 as well.
  const Bounds box{{0, 0, 0}, {8, 8, 8}}, child_box{{4, 4, 4}, {8, 8, 8}};
  const BoxGrid<4> grid(box);
  auto filled = [&](int x, int y, int z) {
    const std::uint64_t child = std::uint64_t{1} << cell_bit(4, x, y, z);
    std::uint64_t mask = 0;
    fill_from<4>(grid, box, &mask, child_box, &child);
    return mask;
  };
  auto box_mask = [](int first, int last) { return box_of_cells<4>({{first, first, first}, {last, last, last}})[0]; };
  EXPECT_EQ(filled(1, 1, 1), box_mask(2, 2));
  EXPECT_EQ(filled(3, 3, 3), box_mask(3, 3));
  EXPECT_EQ(filled(0, 0, 0), box_mask(1, 2));
}

TEST(FillPattern, signs_of_sums_are_exact) {
  EXPECT_EQ(sign_of_sum({0x1p100, 1, -0x1p100, -1}), 0);
  EXPECT_EQ(sign_of_sum({0x1p100, 0x1p-100, -0x1p100, 0}), 1);
  EXPECT_EQ(sign_of_sum({0x1p100, -0x1p-100, -0x1p100, 0}), -1);
  EXPECT_EQ(sign_of_sum({0, 0, 0, 0}), 0);
}

}  // namespace
}  // namespace ctu::cull
