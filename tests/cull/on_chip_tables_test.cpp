// What lies on chip: bits against closed forms, and rows that hold what the test of the key needs.
#include "model/cull/on_chip_tables.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/base/error.h"
#include "model/cull/mask_mirror.h"

namespace ctu::cull {
namespace {

std::shared_ptr<const CompressionLut> lut_of(int resolution, int entries) {
  // Any masks will do: numbers in the first word.
  std::vector<std::uint64_t> masks;
  for (int i = 1; i < entries; ++i) {
    masks.push_back(static_cast<std::uint64_t>(i));
    masks.resize(masks.size() + static_cast<std::size_t>(words_per_mask(resolution) - 1));
  }
  return std::make_shared<const CompressionLut>(resolution, masks);
}

/// Bits on chip without the tables themselves.
std::uint64_t bits_of_design(Design design, const MaskOptions& options, TableRows rows, int projection_tables = 3) {
  return OnChipTables(design, options, options.entries, nullptr, rows, projection_tables).bits();
}

TEST(OnChipTables, take_the_closed_forms_of_every_resolution) {
  for (const int r : {2, 3, 4, 6, 8})
    for (int n = r; n <= 3 * r; ++n)
      for (const int entries : {0, 16, 256, 4096}) {
        SCOPED_TRACE("R " + std::to_string(r) + ", R_ray " + std::to_string(n) + ", entries " +
                     std::to_string(entries));
        const MaskOptions options{.resolution = r, .ray_resolution = n, .entries = entries};
        const auto bits = [&](Design design, TableRows rows, int tables = 3) {
          return bits_of_design(design, options, rows, tables);
        };
        // n^2 pairs of cells on an axis; classes under reversal and mirroring as in key_fold_test.cpp.
        const auto axis = static_cast<std::uint64_t>(n), columns = static_cast<std::uint64_t>(entries);
        const auto square = static_cast<std::uint64_t>(r * r), cells = square * static_cast<std::uint64_t>(r);
        const std::uint64_t pairs = axis * axis, fixed = pairs + axis % 2, corners = pairs * axis;
        const std::uint64_t lut = columns * cells;
        ASSERT_EQ(bits(Design::MaskLut, TableRows::All), pairs * pairs * pairs * cells + lut);
        ASSERT_EQ(bits(Design::MaskLut, TableRows::Folded), (fixed * fixed * fixed + 8 * corners) / 16 * cells + lut);
        ASSERT_EQ(bits(Design::Projection, TableRows::All, 1), pairs * pairs * square + lut);
        ASSERT_EQ(bits(Design::Projection, TableRows::All), 3 * pairs * pairs * square + lut);
        ASSERT_EQ(bits(Design::Projection, TableRows::Folded), 3 * ((fixed * fixed + 4 * pairs) / 8) * square + lut);
        ASSERT_EQ(bits(Design::Comparators, TableRows::Reachable), lut);
        ASSERT_EQ(bits(Design::Ideal, TableRows::All), 0u);
        ASSERT_EQ(bits(Design::BitTable, TableRows::All), pairs * pairs * pairs * columns);
        ASSERT_EQ(bits(Design::BitTable, TableRows::Folded), corners * (corners + 1) / 2 * columns);
      }
}

TEST(OnChipTables, take_the_sizes_that_the_design_page_states) {
  constexpr std::uint64_t kKiB = 8 * 1024;
  const auto bits = [](Design design, int r, int n, int tables = 3) {
    return bits_of_design(design, {.resolution = r, .ray_resolution = n}, TableRows::All, tables);
  };
  EXPECT_EQ(bits(Design::MaskLut, 4, 4), 32 * kKiB);
  EXPECT_EQ(bits(Design::MaskLut, 4, 8), 2048 * kKiB);
  EXPECT_EQ(bits(Design::MaskLut, 6, 6), 46656u * 216);
  EXPECT_EQ(bits(Design::MaskLut, 8, 8), 16 * 1024 * kKiB);
  EXPECT_EQ(bits(Design::Projection, 4, 4, 1), kKiB / 2);
  EXPECT_EQ(bits(Design::Projection, 4, 8), 24 * kKiB);
  EXPECT_EQ(bits(Design::Projection, 6, 6, 1), 1296u * 36);
  EXPECT_EQ(bits(Design::Projection, 8, 8), 96 * kKiB);
  EXPECT_EQ(bits(Design::Projection, 6, 12, 1), 20736u * 36);
  const auto dedup = [](int n) {
    return OnChipTables(MaskTester(Design::Dedup, {.ray_resolution = n}), TableRows::All, 3).bits();
  };
  EXPECT_EQ(dedup(4), 4096u * 11 + 1270u * 64);
  EXPECT_EQ(dedup(8), 262144u * 15 + 20770u * 64);
}

TEST(OnChipTables, over_compressed_masks_keep_the_lut_or_bits_for_its_entries) {
  const auto lut = lut_of(4, 256);
  const auto bits = [&](Design design) { return OnChipTables(MaskTester(design, {}, lut), TableRows::All, 3).bits(); };
  constexpr std::uint64_t kLutBits = 256 * 64;
  EXPECT_EQ(bits(Design::BitTable), 8u * 128 * 1024);
  EXPECT_EQ(bits(Design::MaskLut), 4096u * 64 + kLutBits);
  EXPECT_EQ(bits(Design::Projection), 3u * 256 * 16 + kLutBits);
  EXPECT_EQ(bits(Design::Comparators), kLutBits);
  EXPECT_EQ(bits(Design::Dedup), 4096u * 11 + 1270u * 256);
  EXPECT_EQ(bits(Design::None), 0u);
}

TEST(OnChipTables, a_lane_reads_rows_that_are_there_one_for_each_table_of_its_design) {
  const auto lut = lut_of(4, 256);
  const CellKey key = numbered_key(4095, 4);
  TableRead reads[kMaxReadsOfLane];
  for (const Design design : {Design::MaskLut, Design::Dedup, Design::Projection}) {
    const OnChipTables tables(MaskTester(design, {}), TableRows::All, 3);
    const int count = tables.reads(key, 0, reads);
    ASSERT_EQ(count, static_cast<int>(tables.tables().size()));
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(reads[i].table, i);
      EXPECT_LT(reads[i].row, tables.tables()[static_cast<std::size_t>(i)].rows);
    }
  }
  const OnChipTables single(MaskTester(Design::Projection, {}, lut), TableRows::All, 1);
  EXPECT_EQ(single.reads(key, 200, reads), 4);
  EXPECT_EQ(reads[2].table, 0);
  EXPECT_EQ(reads[3].table, 1);
  EXPECT_EQ(reads[3].row, 200u);
}

TEST(OnChipTables, folded_and_reachable_rows_take_the_closed_forms) {
  const auto lut = lut_of(4, 256);
  const auto rows = [&](Design design, TableRows policy, int ray, bool compressed = false) {
    const MaskTester tester(design, {.ray_resolution = ray}, compressed ? lut : nullptr);
    return OnChipTables(tester, policy, 1).tables().front().rows;
  };
  // R_ray even: (R_ray^6 + 8 R_ray^3) / 16, and that of R_ray - 2 left out; N (N + 1) / 2 of N = R_ray^3 cells.
  EXPECT_EQ(rows(Design::MaskLut, TableRows::Folded, 4), 288u);
  EXPECT_EQ(rows(Design::MaskLut, TableRows::Reachable, 4), 280u);
  EXPECT_EQ(rows(Design::MaskLut, TableRows::Folded, 8), 16640u);
  EXPECT_EQ(rows(Design::MaskLut, TableRows::Reachable, 8), 13616u);
  EXPECT_EQ(rows(Design::Dedup, TableRows::Folded, 4), 288u);
  EXPECT_EQ(rows(Design::Dedup, TableRows::Folded, 4, true), 2080u);
  EXPECT_EQ(rows(Design::BitTable, TableRows::Folded, 4, true), 2080u);
  EXPECT_EQ(rows(Design::BitTable, TableRows::Reachable, 4, true), 2080u - 36u);
  // (R_ray^4 + 4 R_ray^2) / 8; all of them can be reached.
  EXPECT_EQ(rows(Design::Projection, TableRows::Folded, 4), 40u);
  EXPECT_EQ(rows(Design::Projection, TableRows::Reachable, 8), 544u);
}

TEST(OnChipTables, keys_read_the_same_row_of_distinct_masks_iff_their_masks_are_equal_or_mirror_images) {
  const MaskTester tester(Design::Dedup, {.ray_resolution = 5});
  const DedupTable& dedup = *tester.dedup_table();
  MirrorNumbering images(4);
  for (const TableRows policy : {TableRows::All, TableRows::Folded, TableRows::Reachable}) {
    SCOPED_TRACE(std::string(to_string(policy)));
    const OnChipTables tables(tester, policy, 3);
    std::vector<std::uint32_t> mask_in_row(tables.tables()[1].rows, kNoRow);
    for (std::uint32_t number = 0; number < key_count(5); ++number) {
      TableRead reads[kMaxReadsOfLane];
      const int count = tables.reads(numbered_key(number, 5), 0, reads);
      if (count == -1) continue;
      ASSERT_EQ(count, 2);
      ASSERT_LT(reads[0].row, tables.tables()[0].rows);
      ASSERT_LT(reads[1].row, tables.tables()[1].rows);
      const std::uint32_t id = dedup.id(number);
      const std::uint32_t mask = policy == TableRows::All ? id : images.number_of(dedup.row(id)).number;
      std::uint32_t& in_row = mask_in_row[reads[1].row];
      if (in_row == kNoRow) in_row = mask;
      ASSERT_EQ(in_row, mask);
    }
    std::sort(mask_in_row.begin(), mask_in_row.end());
    EXPECT_EQ(std::adjacent_find(mask_in_row.begin(), mask_in_row.end()), mask_in_row.end());
    EXPECT_EQ(std::count(mask_in_row.begin(), mask_in_row.end(), kNoRow), 0);
  }
}

TEST(MirrorNumbering, gives_back_the_mask_from_number_and_axes) {
  for (const int r : {2, 4, 5}) {
    const DedupTable dedup(r, r, nullptr);
    const auto words = static_cast<std::size_t>(words_per_mask(r));
    MirrorNumbering images(r);
    for (std::uint32_t id = 0; id < dedup.distinct(); ++id) {
      const auto [number, axes] = images.number_of(dedup.row(id));
      const auto mask = mirrored_mask(images.masks().data() + number * words, r, axes);
      ASSERT_TRUE(std::equal(mask.begin(), mask.end(), dedup.row(id)));
    }
    EXPECT_LT(images.count(), dedup.distinct());
  }
}

TEST(OnChipTables, reachable_rows_are_missing_only_for_keys_that_begin_inside) {
  const auto lut = lut_of(4, 256);
  for (const Design design : {Design::MaskLut, Design::BitTable, Design::Dedup, Design::Projection}) {
    const OnChipTables tables(MaskTester(design, {.ray_resolution = 5}, lut), TableRows::Reachable, 3);
    int left_out = 0;
    for (std::uint32_t number = 0; number < key_count(5); ++number) {
      const CellKey key = numbered_key(number, 5);
      TableRead reads[kMaxReadsOfLane];
      const bool missing = tables.reads(key, 0, reads) < 0;
      left_out += missing;
      for (int axis = 0; axis < 3; ++axis) ASSERT_FALSE(missing && (key.begin(axis) == 0 || key.begin(axis) == 4));
    }
    EXPECT_EQ(left_out, design == Design::Projection ? 0 : 27 * 27) << to_string(design);
  }
}

TEST(UsedRows, counts_rows_once_over_all_tables) {
  const auto lut = lut_of(4, 256);
  const OnChipTables tables(MaskTester(Design::Projection, {}, lut), TableRows::All, 3);
  UsedRows used(tables);
  CellKey a, b;
  a.set(0, 1, 2);
  b.set(0, 1, 2);
  b.set(1, 3, 3);
  used.add(a, 7);
  used.add(b, 7);
  used.add(b, 9);
  const std::vector<OnChipTable> rows = used.tables();
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].rows, 2u);  // xy
  EXPECT_EQ(rows[1].rows, 2u);  // yz
  EXPECT_EQ(rows[2].rows, 1u);  // xz
  EXPECT_EQ(rows[3].rows, 2u);
  EXPECT_EQ(bits_of(rows), 5u * 16 + 2u * 64);
}

TEST(OnChipTables, given_two_projection_tables_then_they_throw) {
  EXPECT_THROW(OnChipTables(MaskTester(Design::Projection, {}), TableRows::All, 2), Error);
}

}  // namespace
}  // namespace ctu::cull
