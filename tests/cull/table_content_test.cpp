// What rows hold, read as the unit in gates reads them, gives the masks of the model's tables for every key.
#include "model/cull/table_content.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/cull/key_fold.h"
#include "model/cull/mask_mirror.h"

namespace ctu::cull {
namespace {

constexpr int kResolution = 3, kRayResolution = 4;

unsigned mirrored_axes(TableRows rows, CellKey key) {
  if (rows == TableRows::All) return 0;
  const auto pair = [&](int axis) {
    return static_cast<std::uint32_t>(key.begin(axis) + kRayResolution * key.end(axis));
  };
  return MirrorFold<3>(kRayResolution, false).fold({{pair(0), pair(1), pair(2)}}).mirrored;
}

/// What a read of mask-lut or dedup finds: the row, mirrored as key and id say.
std::vector<std::uint64_t> mask_read(const TableContent& content, const TableRead (&reads)[kMaxReadsOfLane], int count,
                                     TableRows rows, unsigned axes) {
  if (count == 1) return mirrored_mask(content.row(0, reads[0].row), kResolution, axes);
  std::uint64_t id = *content.row(0, reads[0].row);
  if (rows != TableRows::All) {
    axes ^= static_cast<unsigned>(id & 7);
    id >>= 3;
  }
  return mirrored_mask(content.row(1, id), kResolution, axes);
}

TEST(TableContent, rows_mirrored_back_are_the_masks_of_all_keys) {
  const MaskOptions options{.resolution = kResolution, .ray_resolution = kRayResolution};
  const RayMaskTable masks(kResolution, kRayResolution);
  for (const Design design : {Design::MaskLut, Design::Dedup}) {
    const MaskTester tester(design, options);
    for (const TableRows rows : {TableRows::All, TableRows::Folded, TableRows::Reachable}) {
      SCOPED_TRACE(std::string(to_string(design)) + ", " + std::string(to_string(rows)));
      const TableContent content(tester, rows, 3);
      const OnChipTables tables(tester, rows, 3);
      int compared = 0;
      for (std::uint32_t number = 0; number < key_count(kRayResolution); ++number) {
        const CellKey key = numbered_key(number, kRayResolution);
        TableRead reads[kMaxReadsOfLane];
        const int count = tables.reads(key, 0, reads);
        if (count < 0) continue;
        const auto mask = mask_read(content, reads, count, rows, mirrored_axes(rows, key));
        ASSERT_TRUE(std::equal(mask.begin(), mask.end(), masks.row(number))) << "key number " << number;
        ++compared;
      }
      EXPECT_GT(compared, 3000);
    }
  }
}

}  // namespace
}  // namespace ctu::cull
