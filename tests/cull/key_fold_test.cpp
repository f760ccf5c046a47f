// Folded rows: one for each class of keys that must have one, and in it what every key of the class has, bit for bit.
#include "model/cull/key_fold.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/cull/key_number.h"
#include "model/cull/projection_table.h"
#include "model/cull/ray_mask_table.h"

namespace ctu::cull {
namespace {

/// The mask with cell c of each axis in `mirrored` at R - 1 - c.
std::vector<std::uint64_t> mirror(const std::uint64_t* mask, int r, unsigned mirrored) {
  std::vector<std::uint64_t> out(static_cast<std::size_t>(words_per_mask(r)));
  const auto place = [&](int cell, int axis) { return (mirrored >> axis & 1) != 0 ? r - 1 - cell : cell; };
  for (int z = 0; z < r; ++z)
    for (int y = 0; y < r; ++y)
      for (int x = 0; x < r; ++x) {
        const int from = cell_bit(r, x, y, z), to = cell_bit(r, place(x, 0), place(y, 1), place(z, 2));
        out[static_cast<std::size_t>(to / 64)] |= (mask[from / 64] >> (from % 64) & 1) << (to % 64);
      }
  return out;
}

std::uint64_t mirror_projection(std::uint64_t row, int r, unsigned mirrored) {
  std::uint64_t out = 0;
  for (int j = 0; j < r; ++j)
    for (int i = 0; i < r; ++i)
      out |= (row >> (i + r * j) & 1) << (((mirrored & 1) != 0 ? r - 1 - i : i) +
                                          r * ((mirrored & 2) != 0 ? r - 1 - j : j));
  return out;
}

MirrorFold<3>::Pairs pairs_of(CellKey key, int n) {
  const auto pair = [&](int axis) { return static_cast<std::uint32_t>(key.begin(axis) + n * key.end(axis)); };
  return {{pair(0), pair(1), pair(2)}};
}

bool inner(const CellKey& key, bool begin, int n) {
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = begin ? key.begin(axis) : key.end(axis);
    if (cell == 0 || cell == n - 1) return false;
  }
  return true;
}

std::uint64_t power(std::uint64_t base, int exponent) { return exponent == 0 ? 1 : base * power(base, exponent - 1); }

/// Classes of keys of `axes` axes under reversal and mirroring, by Burnside's lemma: n^2 pairs on an axis are fixed by
/// nothing done, one or none by mirroring, n by reversal, n by both.
std::uint64_t mirrored_classes(int n, int axes) {
  const auto cells = static_cast<std::uint64_t>(n);
  return (power(cells * cells + cells % 2, axes) + power(2 * cells, axes)) / (2 * power(2, axes));
}

std::uint64_t reversed_classes(int n) {
  const std::uint64_t cells = power(static_cast<std::uint64_t>(n), 3);
  return cells * (cells + 1) / 2;
}

TEST(MirrorFold, gives_every_class_of_keys_one_row_and_no_row_to_none) {
  for (int n = 2; n <= 7; ++n)
    for (const bool leave_out_inner : {false, true}) {
      SCOPED_TRACE(n);
      const MirrorFold<3> fold(n, leave_out_inner);
      ASSERT_EQ(fold.rows(), mirrored_classes(n, 3) - (leave_out_inner ? mirrored_classes(n - 2, 3) : 0));
      std::vector<bool> seen(fold.rows());
      for (std::uint32_t number = 0; number < key_count(n); ++number) {
        const CellKey key = numbered_key(number, n);
        const std::uint32_t row = fold.row(pairs_of(key, n));
        const FoldedKey folded = fold.fold(pairs_of(key, n));
        ASSERT_EQ(row, folded.row);
        ASSERT_EQ(row == kNoRow, leave_out_inner && inner(key, true, n) && inner(key, false, n)) << number;
        if (row == kNoRow) continue;
        ASSERT_LT(row, fold.rows());
        seen[row] = true;
        ASSERT_EQ(fold.row(pairs_of(folded.canonical, n)), row);
        ASSERT_EQ(fold.fold(pairs_of(folded.canonical, n)).mirrored, 0u);
        ASSERT_EQ(fold.fold(pairs_of(folded.canonical, n)).canonical.packed, folded.canonical.packed);
        ASSERT_EQ(fold.row(pairs_of(reversed(key), n)), row);
      }
      ASSERT_EQ(std::count(seen.begin(), seen.end(), false), 0);
    }
}

struct Sizes {
  int r, ray;
};

TEST(MirrorFold, the_canonical_keys_mask_mirrored_is_the_keys_own_bit_for_bit) {
  for (const Sizes s : {Sizes{2, 2}, Sizes{2, 3}, Sizes{2, 5}, Sizes{3, 3}, Sizes{3, 4}, Sizes{3, 5}, Sizes{4, 4},
                        Sizes{4, 5}, Sizes{4, 6}, Sizes{5, 5}}) {
    SCOPED_TRACE("R " + std::to_string(s.r) + ", R_ray " + std::to_string(s.ray));
    const RayMaskTable table(s.r, s.ray);
    const MirrorFold<3> fold(s.ray, false);
    for (std::uint32_t number = 0; number < table.rows(); ++number) {
      const FoldedKey folded = fold.fold(pairs_of(numbered_key(number, s.ray), s.ray));
      const auto mask = mirror(table.row(table.row_index(folded.canonical)), s.r, folded.mirrored);
      ASSERT_TRUE(std::equal(mask.begin(), mask.end(), table.row(number))) << number;
    }
  }
}

TEST(MirrorFold, of_projections_gives_each_class_one_row_that_mirrors_bit_for_bit) {
  for (int r = kMinResolution; r <= kMaxResolution; ++r)
    for (int n = r; n <= std::min(3 * r, 13); ++n) {
      SCOPED_TRACE("R " + std::to_string(r) + ", R_ray " + std::to_string(n));
      const ProjectionTable table(r, n);
      const MirrorFold<2> fold(n, false);
      ASSERT_EQ(fold.rows(), mirrored_classes(n, 2));
      const auto cells = static_cast<std::uint32_t>(n);
      for (std::uint32_t number = 0; number < table.rows(); ++number) {
        const std::uint32_t begin_a = number % cells, begin_b = number / cells % cells;
        const std::uint32_t end_a = number / (cells * cells) % cells, end_b = number / (cells * cells * cells);
        const FoldedKey folded = fold.fold({{begin_a + cells * end_a, begin_b + cells * end_b}});
        ASSERT_LT(folded.row, fold.rows());
        ASSERT_EQ(mirror_projection(table.row(table.row_index(folded.canonical, AxisPair::XY)), r, folded.mirrored),
                  table.row(number));
      }
    }
}

TEST(ReverseFold, gives_a_key_and_its_reverse_one_row_and_no_row_to_none) {
  for (int n = 2; n <= 6; ++n)
    for (const bool leave_out_inner : {false, true}) {
      SCOPED_TRACE(n);
      const ReverseFold fold(n, leave_out_inner);
      ASSERT_EQ(fold.rows(), reversed_classes(n) - (leave_out_inner ? reversed_classes(n - 2) : 0));
      std::vector<bool> seen(fold.rows());
      for (std::uint32_t number = 0; number < key_count(n); ++number) {
        const CellKey key = numbered_key(number, n);
        const std::uint32_t row = fold.row(key);
        ASSERT_EQ(row, fold.row(reversed(key)));
        ASSERT_EQ(row == kNoRow, leave_out_inner && inner(key, true, n) && inner(key, false, n)) << number;
        if (row == kNoRow) continue;
        ASSERT_LT(row, fold.rows());
        seen[row] = true;
      }
      ASSERT_EQ(std::count(seen.begin(), seen.end(), false), 0);
    }
}

}  // namespace
}  // namespace ctu::cull
