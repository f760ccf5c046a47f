// The two designs that find a ray's cells without a table, against exact arithmetic.
#include <gtest/gtest.h>

#include <bit>

#include "model/cull/comparators.h"
#include "model/cull/ideal.h"
#include "model/cull/options.h"
#include "tests/cull/cases.h"
#include "tests/oracle/exact_cells.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

using test::Family;
using test::RayAndBox;

using CellSet = std::vector<std::uint8_t>;

struct Touched {
  CellSet comparators, ideal;
};

CellSet unpack(const std::vector<std::uint64_t>& words, int resolution) {
  CellSet cells(static_cast<std::size_t>(resolution * resolution * resolution));
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = words[i / 64] >> (i % 64) & 1;
  return cells;
}

/// False when the slab test misses the box.
bool find_cells(const RayAndBox& c, int resolution, Touched& out) {
  const intersect::PreparedRay ray = intersect::prepare_ray(c.ray);
  const intersect::Box4 boxes = test::box_in_lane_0(c.lo, c.hi);
  const intersect::SlabTimes times = intersect::slab_test(ray, boxes, c.ray.tmax);
  if (!ray.valid || (times.hit & 1) == 0) return false;
  std::vector<std::uint64_t> words(static_cast<std::size_t>(words_per_mask(resolution)), ~std::uint64_t{0});
  comparator_mask(ray, times, boxes, 0, resolution, words.data());
  out.comparators = unpack(words, resolution);
  ideal_mask(ray, times, boxes, 0, resolution, words.data());
  out.ideal = unpack(words, resolution);
  return true;
}

bool contains(const CellSet& larger, const CellSet& smaller) {
  for (std::size_t i = 0; i < larger.size(); ++i)
    if (smaller[i] != 0 && larger[i] == 0) return false;
  return true;
}

int count(const CellSet& cells) {
  int n = 0;
  for (const std::uint8_t cell : cells) n += cell != 0;
  return n;
}

CellSet exact_cells(const RayAndBox& c, int resolution, oracle::Cells cells) {
  return oracle::exact_ray_cells(c.ray, c.lo, c.hi, resolution, c.ray.tmin, c.ray.tmax, cells);
}

class TouchedCells : public testing::TestWithParam<Family> {};

TEST_P(TouchedCells, both_hold_every_closed_cell_and_comparators_every_cell_of_ideal) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed());
  int asked = 0;
  for (int i = 0; i < 400; ++i) {
    const RayAndBox c = make.ray_and_box(GetParam());
    const int resolution = make.integer(kMinResolution, kMaxResolution);
    SCOPED_TRACE("R " + std::to_string(resolution) + ": " + test::text(c));
    Touched found;
    if (!find_cells(c, resolution, found)) {
      ASSERT_EQ(count(exact_cells(c, resolution, oracle::Cells::Closed)), 0);
      continue;
    }
    ++asked;
    const CellSet exact = exact_cells(c, resolution, oracle::Cells::Closed);
    ASSERT_TRUE(contains(found.comparators, exact));
    ASSERT_TRUE(contains(found.ideal, exact));
    ASSERT_TRUE(contains(found.comparators, found.ideal));
  }
  EXPECT_GT(asked, 20);
}

TEST_P(TouchedCells, ideal_is_the_exact_closed_cells_but_for_binary64_rounding) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed() + 1);
  int ideal = 0, exact = 0;
  for (int i = 0; i < 400; ++i) {
    const RayAndBox c = make.ray_and_box(GetParam());
    const int resolution = make.integer(kMinResolution, kMaxResolution);
    Touched found;
    if (!find_cells(c, resolution, found)) continue;
    const int touched = count(exact_cells(c, resolution, oracle::Cells::Closed));
    // A box that only rounding lets the ray hit keeps the cells at its entry.
    EXPECT_GT(count(found.ideal), 0);
    if (touched == 0) continue;
    ideal += count(found.ideal);
    exact += touched;
  }
  EXPECT_GE(ideal, exact);
  EXPECT_LE(ideal, exact + exact / 1000);
}

INSTANTIATE_TEST_SUITE_P(Families, TouchedCells, testing::ValuesIn(test::families()),
                         [](const auto& info) { return test::identifier(info.param); });

TEST(Comparators, mark_hardly_more_than_the_exact_cells_of_near_boxes) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed());
  const struct {
    float offset;
    double most_extra;  // share of the exact cells
  } cases[] = {{1, 0.001}, {1e2f, 0.005}, {1e4f, 0.05}};
  for (const auto& entry : cases) {
    const Family family{.name = "plain", .offset = entry.offset};
    int marked = 0, exact = 0;
    for (int i = 0; i < 1000; ++i) {
      RayAndBox c;
      make.box(family, c.lo, c.hi);
      const Vec3 target{make.uniform(c.lo.x, c.hi.x), make.uniform(c.lo.y, c.hi.y), make.uniform(c.lo.z, c.hi.z)};
      c.ray = make.ray_to(family, c.lo, c.hi, target);
      Touched found;
      if (!find_cells(c, 4, found)) continue;
      marked += count(found.comparators);
      exact += count(exact_cells(c, 4, oracle::Cells::Closed));
    }
    EXPECT_LE(marked, exact * (1 + entry.most_extra)) << "offset " << entry.offset;
  }
}

TEST(Comparators, a_ray_along_a_border_touches_the_cells_on_both_sides) {
  Touched found;
  ASSERT_TRUE(find_cells({{{-1, 2, 0.5f}, 0, {1, 0, 0}, 100}, {0, 0, 0}, {4, 4, 4}}, 4, found));
  CellSet expected(64);
  for (int y = 1; y <= 2; ++y)
    for (int x = 0; x < 4; ++x) expected[static_cast<std::size_t>(cell_bit(4, x, y, 0))] = 1;
  EXPECT_EQ(found.comparators, expected);
  EXPECT_EQ(found.ideal, expected);
}

TEST(Comparators, given_a_diagonal_then_the_cells_at_the_crossings_corners_are_touched_too) {
  Touched found;
  ASSERT_TRUE(find_cells({{{-1, -1, 0.5f}, 0, {1, 1, 0}, 100}, {0, 0, 0}, {4, 4, 4}}, 4, found));
  int cells = 0;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      const bool touched = found.comparators[static_cast<std::size_t>(cell_bit(4, x, y, 0))] != 0;
      EXPECT_EQ(touched, std::abs(x - y) <= 1) << x << "," << y;
      cells += touched;
    }
  EXPECT_EQ(count(found.comparators), cells);
}

}  // namespace
}  // namespace ctu::cull
