// rtl/mirror_fold.sv and reverse_fold.sv against model/cull/key_fold.h: the row of every key, and how it is mirrored.
#include "model/cull/key_fold.h"

#include <gtest/gtest.h>

#include <random>

#include "VFoldBench.h"
#include "model/cull/key_number.h"
#include "tests/oracle/seed.h"

namespace ctu::rtl {
namespace {

using cull::CellKey;

constexpr int kLongest = 9;  // of fold_bench.sv

class Folds {
 public:
  explicit Folds(int n)
      : n_(n),
        mirror_{cull::MirrorFold<3>(n, false), cull::MirrorFold<3>(n, true)},
        reverse_{cull::ReverseFold(n, false), cull::ReverseFold(n, true)},
        project_(n, false) {}

  void expect_equal(VFoldBench& bench, CellKey key) const {
    bench.key_i = key.packed;
    bench.eval();
    for (const int leave_out : {0, 1}) {
      const cull::FoldedKey folded = mirror_[leave_out].fold({{pair(key, 0), pair(key, 1), pair(key, 2)}});
      ASSERT_EQ(bench.mirrored_left_o[n_][leave_out], folded.row == cull::kNoRow);
      if (folded.row != cull::kNoRow) {
        ASSERT_EQ(bench.mirrored_row_o[n_][leave_out], folded.row);
        ASSERT_EQ(bench.mirrored_o[n_][leave_out], folded.mirrored);
      }
      const std::uint32_t row = reverse_[leave_out].row(key);
      ASSERT_EQ(bench.reversed_left_o[n_][leave_out], row == cull::kNoRow);
      if (row != cull::kNoRow) {
        ASSERT_EQ(bench.reversed_row_o[n_][leave_out], row);
      }
    }
    const cull::FoldedKey projected = project_.fold({{pair(key, 0), pair(key, 1)}});
    ASSERT_EQ(bench.projected_row_o[n_], projected.row);
    ASSERT_EQ(bench.projected_o[n_], projected.mirrored);
  }

 private:
  std::uint32_t pair(CellKey key, int axis) const {
    return static_cast<std::uint32_t>(key.begin(axis) + n_ * key.end(axis));
  }

  int n_;
  cull::MirrorFold<3> mirror_[2];
  cull::ReverseFold reverse_[2];
  cull::MirrorFold<2> project_;
};

TEST(RtlKeyFold, rows_and_mirrored_axes_of_every_key_or_of_many) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937 random(static_cast<std::uint32_t>(oracle::test_seed()));
  const auto bench = std::make_unique<VFoldBench>();
  for (int n = 2; n <= kLongest; ++n) {
    const Folds folds(n);
    const std::uint32_t keys = cull::key_count(n), tested = std::min(keys, 20'000u);
    for (std::uint32_t i = 0; i < tested; ++i) {
      const std::uint32_t number = keys == tested ? i : random() % keys;
      folds.expect_equal(*bench, cull::numbered_key(number, n));
      ASSERT_FALSE(testing::Test::HasFailure()) << "R_ray " << n << ", key number " << number;
    }
  }
}

}  // namespace
}  // namespace ctu::rtl
