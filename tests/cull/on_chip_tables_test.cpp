// What lies on chip: bits against closed forms, and rows that hold what the test of the key needs.
#include "model/cull/on_chip_tables.h"

#include <gtest/gtest.h>

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

TEST(OnChipTables, given_two_projection_tables_then_they_throw) {
  EXPECT_THROW(OnChipTables(MaskTester(Design::Projection, {}), TableRows::All, 2), Error);
}

}  // namespace
}  // namespace ctu::cull
