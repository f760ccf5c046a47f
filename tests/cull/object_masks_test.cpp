// Object masks from all triangles, against exact arithmetic.
#include "model/cull/object_masks.h"

#include <gtest/gtest.h>

#include "model/accel/build.h"
#include "model/base/error.h"
#include "tests/cull/cases.h"
#include "tests/oracle/exact_cells.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

using test::Family;
using CellSet = std::vector<std::uint8_t>;

CellSet cells_of(const ObjectMasks& masks, std::uint32_t node, int lane) {
  const std::uint64_t* words = masks.mask(node, lane);
  CellSet cells(static_cast<std::size_t>(masks.resolution * masks.resolution * masks.resolution));
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = words[i / 64] >> (i % 64) & 1;
  return cells;
}

void add_exact_cells(CellSet& cells, const Vec3& lo, const Vec3& hi, int resolution, const accel::LeafTriangle& t) {
  const CellSet touched = oracle::exact_triangle_cells(lo, hi, resolution, t.v0, t.v1, t.v2);
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] |= touched[i];
}

/// Every triangle below a child.
void collect(const accel::Bvh4& bvh, accel::ChildRef ref, std::vector<accel::LeafTriangle>& out) {
  if (accel::is_leaf(ref))
    out.insert(out.end(), bvh.triangles.begin() + accel::leaf_first(ref),
               bvh.triangles.begin() + accel::leaf_first(ref) + accel::leaf_count(ref));
  else if (accel::is_inner(ref))
    for (const accel::ChildRef child : bvh.nodes[ref].child) collect(bvh, child, out);
}

class TriangleCells : public testing::TestWithParam<Family> {};

TEST_P(TriangleCells, the_mask_holds_every_closed_cell_touched_and_practically_no_other) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed());
  int marked = 0, exact = 0;
  for (int i = 0; i < 150; ++i) {
    Vec3 lo, hi, v[3];
    make.box(GetParam(), lo, hi);
    make.triangle(GetParam(), lo, hi, v);
    const int resolution = make.integer(kMinResolution, kMaxResolution);
    // A second triangle, so that the box is not just the first one's bounds.
    Vec3 w[3];
    make.triangle(GetParam(), lo, hi, w);
    const accel::Bvh4 bvh = test::one_leaf({{v[0], v[1], v[2], 0}, {w[0], w[1], w[2], 1}});
    const CellSet found = cells_of(build_object_masks(bvh, {.resolution = resolution}, 1), 0, 0);
    CellSet expected(found.size());
    for (const accel::LeafTriangle& t : bvh.triangles) add_exact_cells(expected, bvh.lower, bvh.upper, resolution, t);
    for (std::size_t cell = 0; cell < found.size(); ++cell) {
      ASSERT_GE(found[cell], expected[cell])
          << "R " << resolution << ", cell " << cell << ", box " << test::text(bvh.lower) << test::text(bvh.upper)
          << ", triangles " << test::text(v[0]) << test::text(v[1]) << test::text(v[2]) << " and " << test::text(w[0])
          << test::text(w[1]) << test::text(w[2]);
      marked += found[cell];
      exact += expected[cell];
    }
  }
  EXPECT_LE(marked, exact + exact / 1000);
}

INSTANTIATE_TEST_SUITE_P(Families, TriangleCells, testing::ValuesIn(test::families()),
                         [](const auto& info) { return test::identifier(info.param); });

scene::Mesh random_mesh(std::uint64_t seed, int triangles, float size) {
  test::CaseMaker make(seed);
  scene::Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vec3 center{make.uniform(-1, 1), make.uniform(-1, 1), make.uniform(-1, 1)};
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int v = 0; v < 3; ++v)
      mesh.vertices.push_back({center.x + make.uniform(-size, size), center.y + make.uniform(-size, size),
                               center.z + make.uniform(-size, size)});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(ObjectMasks, every_child_of_a_tree_has_the_exact_cells_of_the_triangles_below_it) {
  SCOPED_TRACE(oracle::seed_note());
  const accel::Bvh4 bvh = accel::build(random_mesh(oracle::test_seed(), 120, 0.3f), {});
  for (const int resolution : {3, 4, 8}) {
    const ObjectMasks masks = build_object_masks(bvh, {.resolution = resolution}, 2);
    for (std::uint32_t node = 0; node < bvh.nodes.size(); ++node)
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        const CellSet found = cells_of(masks, node, lane);
        CellSet expected(found.size());
        std::vector<accel::LeafTriangle> triangles;
        const accel::Node4& n = bvh.nodes[node];
        if (n.child[lane] != accel::kEmptyChild) collect(bvh, n.child[lane], triangles);
        for (const accel::LeafTriangle& t : triangles)
          add_exact_cells(expected, {n.boxes.lo[0][lane], n.boxes.lo[1][lane], n.boxes.lo[2][lane]},
                          {n.boxes.hi[0][lane], n.boxes.hi[1][lane], n.boxes.hi[2][lane]}, resolution, t);
        ASSERT_EQ(found, expected) << "R " << resolution << ", node " << node << ", lane " << lane;
      }
  }
}

TEST(ObjectMasks, given_a_thousand_equal_triangles_then_every_box_has_the_same_mask) {
  scene::Mesh mesh = random_mesh(1, 1, 1);
  for (int i = 1; i < 1000; ++i) mesh.triangles.push_back({0, 1, 2});
  const accel::Bvh4 bvh = accel::build(mesh, {});
  for (const int levels : {kUnlimitedLevels, 1, 3}) {
    const ObjectMasks masks = build_object_masks(bvh, {.resolution = 4, .levels = levels}, 2);
    const CellSet expected =
        oracle::exact_triangle_cells(bvh.lower, bvh.upper, 4, mesh.vertices[0], mesh.vertices[1], mesh.vertices[2]);
    for (std::uint32_t node = 0; node < bvh.nodes.size(); ++node)
      for (int lane = 0; lane < intersect::kLanes; ++lane)
        if (bvh.nodes[node].child[lane] != accel::kEmptyChild) {
          ASSERT_EQ(cells_of(masks, node, lane), expected) << "L " << levels;
        }
  }
}

TEST(ObjectMasks, empty_lanes_are_zero) {
  const accel::Bvh4 bvh = test::one_leaf({{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}, 0}});
  const ObjectMasks masks = build_object_masks(bvh, {.resolution = 6}, 1);
  for (int lane = 1; lane < intersect::kLanes; ++lane)
    for (int w = 0; w < masks.words; ++w) EXPECT_EQ(masks.mask(0, lane)[w], 0u);
}

TEST(ObjectMasks, given_a_flat_box_then_its_one_layer_is_repeated_along_the_flat_axis) {
  const accel::Bvh4 bvh = test::one_leaf({{{0, 5, 0}, {4, 5, 0}, {0, 5, 4}, 0}});
  const CellSet cells = cells_of(build_object_masks(bvh, {.resolution = 4}, 1), 0, 0);
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x)
        EXPECT_EQ(cells[static_cast<std::size_t>(cell_bit(4, x, y, z))], x + z <= 4) << x << y << z;
}

TEST(ObjectMasks, given_a_point_then_all_cells_are_set) {
  const accel::Bvh4 bvh = test::one_leaf({{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, 0}});
  for (const int levels : {kUnlimitedLevels, 1}) {
    const CellSet cells = cells_of(build_object_masks(bvh, {.resolution = 3, .levels = levels}, 1), 0, 0);
    EXPECT_EQ(cells, CellSet(27, 1));
  }
}

TEST(ObjectMasks, given_an_empty_tree_or_bad_options_then_no_masks_or_an_error) {
  accel::Bvh4 empty;
  EXPECT_TRUE(build_object_masks(empty, {}, 2).bits.empty());
  EXPECT_THROW(build_object_masks(empty, {.resolution = 9}, 1), Error);
}

}  // namespace
}  // namespace ctu::cull
