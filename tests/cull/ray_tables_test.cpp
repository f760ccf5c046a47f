// The ray masks: the table by simulated sweep, the projections by separating lines, and here a third opinion by
// separating planes. All three are exact integers and must agree on every key.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <set>

#include "model/base/error.h"
#include "model/cull/projection_table.h"
#include "model/cull/ray_mask_table.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

struct Sizes {
  int r, ray;
};

CellKey key_of(const int (&begin)[3], const int (&end)[3]) {
  CellKey key;
  for (int a = 0; a < 3; ++a) key.set(a, begin[a], end[a]);
  return key;
}

/// The key of a row: begin x fastest, then begin y, z, end x, y, z.
CellKey key_of_row(std::uint32_t row, int ray) {
  CellKey key;
  for (int field = 0; field < 6; ++field, row /= static_cast<std::uint32_t>(ray))
    key.packed |= row % static_cast<std::uint32_t>(ray) << (5 * field);
  return key;
}

bool has_cell(const std::uint64_t* words, int r, int x, int y, int z) {
  const int bit = cell_bit(r, x, y, z);
  return (words[bit / 64] >> (bit % 64) & 1) != 0;
}

/// Whether the open mask cell overlaps the swept open ray cell: a segment against an open box, both grown into one,
/// apart iff a face of the box or a cross product of the segment with a box axis separates them. Doubled units.
bool swept_cell_overlaps(Sizes s, const int (&begin)[3], const int (&end)[3], const int (&cell)[3]) {
  const long units = std::lcm(s.r, s.ray), ray_width = units / s.ray, mask_width = units / s.r;
  long middle[3], way[3];
  const long half = mask_width + ray_width;
  for (int a = 0; a < 3; ++a) {
    middle[a] = (begin[a] + end[a]) * ray_width - (2 * cell[a] + 1) * mask_width + ray_width;
    way[a] = (end[a] - begin[a]) * ray_width;
    if (std::labs(middle[a]) >= half + std::labs(way[a])) return false;
  }
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    if (way[b] == 0 && way[c] == 0) continue;
    if (std::labs(middle[b] * way[c] - middle[c] * way[b]) >= half * (std::labs(way[b]) + std::labs(way[c])))
      return false;
  }
  return true;
}

class RayTables : public testing::TestWithParam<Sizes> {};

TEST_P(RayTables, projections_and_table_agree_on_every_key) {
  const Sizes s = GetParam();
  const RayMaskTable table(s.r, s.ray);
  const ProjectionTable projections(s.r, s.ray);
  ASSERT_EQ(table.rows(), static_cast<std::uint32_t>(std::pow(s.ray, 6)));
  ASSERT_EQ(projections.rows(), static_cast<std::uint32_t>(std::pow(s.ray, 4)));
  std::vector<std::uint64_t> words(static_cast<std::size_t>(table.words()));
  for (std::uint32_t row = 0; row < table.rows(); ++row) {
    const CellKey key = key_of_row(row, s.ray);
    ASSERT_EQ(table.row_index(key), row);
    projections.ray_mask(key, words.data());
    ASSERT_TRUE(std::equal(words.begin(), words.end(), table.row(row))) << "key " << std::hex << key.packed;
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, RayTables,
                         testing::Values(Sizes{2, 2}, Sizes{2, 3}, Sizes{2, 7}, Sizes{3, 3}, Sizes{3, 5}, Sizes{3, 6},
                                         Sizes{3, 7}, Sizes{4, 4}, Sizes{4, 5}, Sizes{4, 6}, Sizes{4, 8}, Sizes{5, 5},
                                         Sizes{5, 7}, Sizes{6, 6}, Sizes{6, 9}, Sizes{7, 7}, Sizes{7, 8}, Sizes{8, 8},
                                         Sizes{8, 9}),
                         [](const auto& info) {
                           return "R" + std::to_string(info.param.r) + "_Rray" + std::to_string(info.param.ray);
                         });

TEST(RayMaskTable, a_cell_is_set_iff_no_plane_separates_it_from_the_swept_cell) {
  for (const Sizes s : {Sizes{2, 5}, Sizes{3, 4}, Sizes{4, 4}, Sizes{4, 6}, Sizes{5, 5}}) {
    const RayMaskTable table(s.r, s.ray);
    for (std::uint32_t row = 0; row < table.rows(); ++row) {
      const CellKey key = key_of_row(row, s.ray);
      const int begin[3] = {key.begin(0), key.begin(1), key.begin(2)}, end[3] = {key.end(0), key.end(1), key.end(2)};
      for (int z = 0; z < s.r; ++z)
        for (int y = 0; y < s.r; ++y)
          for (int x = 0; x < s.r; ++x)
            ASSERT_EQ(has_cell(table.row(row), s.r, x, y, z), swept_cell_overlaps(s, begin, end, {x, y, z}))
                << "R " << s.r << ", R_ray " << s.ray << ", key " << std::hex << key.packed << ", cell " << x << y << z;
    }
  }
}

TEST(ProjectionTable, has_the_cells_that_no_plane_separates_for_every_r_and_r_ray) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  for (int r = kMinResolution; r <= kMaxResolution; ++r)
    for (int n = r; n <= 3 * r; ++n) {
      const ProjectionTable table(r, n);
      std::vector<std::uint64_t> mask(static_cast<std::size_t>(words_per_mask(r)));
      for (int i = 0; i < 60; ++i) {
        const CellKey key = key_of_row(static_cast<std::uint32_t>(random() % key_count(n)), n);
        const int begin[3] = {key.begin(0), key.begin(1), key.begin(2)}, end[3] = {key.end(0), key.end(1), key.end(2)};
        table.ray_mask(key, mask.data());
        for (int z = 0; z < r; ++z)
          for (int y = 0; y < r; ++y)
            for (int x = 0; x < r; ++x)
              ASSERT_EQ(has_cell(mask.data(), r, x, y, z), swept_cell_overlaps({r, n}, begin, end, {x, y, z}))
                  << "R " << r << ", R_ray " << n << ", key " << std::hex << key.packed << ", cell " << x << y << z;
      }
    }
}

TEST(RayMaskTable, every_point_between_two_cells_lies_in_a_set_cell) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  auto pick = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
  for (const Sizes s : {Sizes{4, 4}, Sizes{4, 7}, Sizes{6, 7}, Sizes{8, 8}}) {
    const RayMaskTable table(s.r, s.ray);
    constexpr int kFine = 60, kSteps = 97;  // positions a ray cell, points a segment
    const int span = kFine * s.ray;
    for (int i = 0; i < 20000; ++i) {
      // The box's upper faces belong to its last cells.
      const int from[3] = {pick(span + 1), pick(span + 1), pick(span + 1)};
      const int to[3] = {pick(span + 1), pick(span + 1), pick(span + 1)};
      int begin[3], end[3];
      for (int a = 0; a < 3; ++a) {
        begin[a] = std::min(from[a] / kFine, s.ray - 1);
        end[a] = std::min(to[a] / kFine, s.ray - 1);
      }
      const std::uint64_t* mask = table.row(table.row_index(key_of(begin, end)));
      for (int step = 0; step <= kSteps; ++step) {
        int cell[3];
        for (int a = 0; a < 3; ++a) {
          const int position = from[a] * (kSteps - step) + to[a] * step;  // of span * kSteps
          cell[a] = std::min(position * s.r / (span * kSteps), s.r - 1);
        }
        ASSERT_TRUE(has_cell(mask, s.r, cell[0], cell[1], cell[2])) << "R " << s.r << ", R_ray " << s.ray;
      }
    }
  }
}

TEST(RayMaskTable, distinct_masks_and_mean_cells_are_the_published_ones) {
  const struct {
    Sizes sizes;
    std::size_t distinct;
  } published[] = {{{4, 4}, 1270}, {{4, 8}, 20770}};
  for (const auto& p : published) {
    const RayMaskTable table(p.sizes.r, p.sizes.ray);
    std::set<std::uint64_t> distinct;
    double cells = 0;
    for (std::uint32_t row = 0; row < table.rows(); ++row) {
      distinct.insert(*table.row(row));
      cells += std::popcount(*table.row(row));
    }
    EXPECT_EQ(distinct.size(), p.distinct);
    if (p.sizes.ray == 4) {
      EXPECT_NEAR(cells / table.rows(), 9.48, 0.005);
    }
  }
}

TEST(ProjectionTable, distinct_rows_are_the_published_ones) {
  for (const auto& [sizes, count] : {std::pair{Sizes{4, 4}, 109u}, std::pair{Sizes{4, 8}, 337u}}) {
    const ProjectionTable table(sizes.r, sizes.ray);
    std::set<std::uint64_t> distinct;
    for (std::uint32_t row = 0; row < table.rows(); ++row) distinct.insert(table.row(row));
    EXPECT_EQ(distinct.size(), count);
  }
}

TEST(RayMaskTable, reversing_a_ray_keeps_its_mask) {
  const RayMaskTable table(5, 5);
  for (std::uint32_t row = 0; row < table.rows(); ++row) {
    const std::uint64_t* backwards = table.row(table.row_index(reversed(key_of_row(row, 5))));
    ASSERT_TRUE(std::equal(table.row(row), table.row(row) + table.words(), backwards));
  }
}

TEST(RayMaskTable, a_ray_within_one_cell_has_that_cell_alone) {
  const RayMaskTable table(6, 6);
  for (int z = 0; z < 6; ++z) {
    const std::uint64_t* row = table.row(table.row_index(key_of({1, 5, z}, {1, 5, z})));
    int cells = 0;
    for (int w = 0; w < table.words(); ++w) cells += std::popcount(row[w]);
    EXPECT_EQ(cells, 1);
    EXPECT_TRUE(has_cell(row, 6, 1, 5, z));
  }
}

TEST(RayMaskTable, given_a_table_of_a_gibibyte_then_the_error_names_r_ray_and_a_way_out) {
  try {
    const RayMaskTable table(8, 16);
    FAIL() << "1 GiB was allocated";
  } catch (const Error& error) {
    EXPECT_NE(error.where().find("R_ray = 16"), std::string::npos) << error.what();
    EXPECT_NE(error.remedy().find("projection"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(ProjectionTable(8, 16));
}

TEST(TableLimits, given_a_resolution_that_keys_cannot_hold_then_they_throw) {
  EXPECT_THROW(RayMaskTable(9, 4), Error);
  EXPECT_THROW(RayMaskTable(4, 25), Error);
  EXPECT_THROW(RayMaskTable(4, 3), Error);
  EXPECT_THROW(ProjectionTable(1, 4), Error);
  EXPECT_THROW(ProjectionTable(6, 5), Error);
  EXPECT_NO_THROW(ProjectionTable(8, 24));
}

}  // namespace
}  // namespace ctu::cull
