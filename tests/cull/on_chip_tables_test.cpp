// What lies on chip: bits against closed forms, and rows that hold what the test of the key needs.
#include "model/cull/on_chip_tables.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/base/error.h"

namespace ctu::cull {
namespace {

constexpr Design kTabled[] = {Design::MaskLut, Design::Dedup, Design::Projection};

std::shared_ptr<const CompressionLut> lut_of(int resolution, int entries) {
  // Any masks will do: numbers in the first word.
  std::vector<std::uint64_t> masks;
  for (int i = 1; i < entries; ++i) {
    masks.push_back(static_cast<std::uint64_t>(i));
    masks.resize(masks.size() + static_cast<std::size_t>(words_per_mask(resolution) - 1));
  }
  return std::make_shared<const CompressionLut>(resolution, masks);
}

std::uint64_t bits_of(Design design, int r, int ray, int projection_tables = 3) {
  return OnChipTables(MaskTester(design, {.resolution = r, .ray_resolution = ray}), TableRows::All, projection_tables)
      .bits();
}

TEST(OnChipTables, take_the_bits_of_the_designs_table) {
  constexpr std::uint64_t kKiB = 8 * 1024;
  EXPECT_EQ(bits_of(Design::MaskLut, 4, 4), 32 * kKiB);
  EXPECT_EQ(bits_of(Design::MaskLut, 4, 8), 2048 * kKiB);
  EXPECT_EQ(bits_of(Design::MaskLut, 6, 6), 46656u * 216);
  EXPECT_EQ(bits_of(Design::Projection, 4, 4, 1), kKiB / 2);
  EXPECT_EQ(bits_of(Design::Projection, 4, 4), 3 * kKiB / 2);
  EXPECT_EQ(bits_of(Design::Projection, 4, 8), 24 * kKiB);
  EXPECT_EQ(bits_of(Design::Projection, 6, 6, 1), 1296u * 36);
  EXPECT_EQ(bits_of(Design::Projection, 8, 8), 96 * kKiB);
  EXPECT_EQ(bits_of(Design::Projection, 6, 12, 1), 20736u * 36);
  EXPECT_EQ(bits_of(Design::Dedup, 4, 4), 4096u * 11 + 1270u * 64);
  EXPECT_EQ(bits_of(Design::Dedup, 4, 8), 262144u * 15 + 20770u * 64);
  for (const Design design : {Design::None, Design::Ideal, Design::Comparators}) EXPECT_EQ(bits_of(design, 4, 4), 0u);
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
  for (const Design design : kTabled) {
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

TEST(OnChipTables, of_a_deduplicated_table_a_key_reads_the_row_of_its_mask) {
  // Rows with the same id must have the same mask; mirrored, when masks are.
  const MaskTester tester(Design::Dedup, {.ray_resolution = 5});
  const DedupTable& dedup = *tester.dedup_table();
  for (const TableRows policy : {TableRows::All, TableRows::Folded, TableRows::Reachable}) {
    SCOPED_TRACE(std::string(to_string(policy)));
    const OnChipTables tables(tester, policy, 3);
    const MirrorFold<3> fold(5, false);
    std::vector<std::uint32_t> id_in_row(tables.tables()[1].rows, kNoRow);
    for (std::uint32_t number = 0; number < key_count(5); ++number) {
      const CellKey key = numbered_key(number, 5);
      TableRead reads[kMaxReadsOfLane];
      const int count = tables.reads(key, 0, reads);
      if (count == -1) continue;
      ASSERT_EQ(count, 2);
      ASSERT_LT(reads[0].row, tables.tables()[0].rows);
      ASSERT_LT(reads[1].row, tables.tables()[1].rows);
      const auto pair = [&](int axis) { return static_cast<std::uint32_t>(key.begin(axis) + 5 * key.end(axis)); };
      const CellKey read = policy == TableRows::All ? key : fold.fold({{pair(0), pair(1), pair(2)}}).canonical;
      std::uint32_t& id = id_in_row[reads[1].row];
      if (id == kNoRow) id = dedup.id(key_number(read, 5));
      ASSERT_EQ(id, dedup.id(key_number(read, 5)));
    }
    EXPECT_EQ(std::count(id_in_row.begin(), id_in_row.end(), kNoRow), 0);
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
