// Algorithm 3 against the brute-force search, for every resolution and LUTs of all sizes.
#include "model/cull/requirement_luts.h"

#include <gtest/gtest.h>

#include "model/base/error.h"
#include "model/cull/mask_words.h"
#include "tests/cull/random_masks.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

class EveryResolution : public testing::TestWithParam<int> {};

TEST_P(EveryResolution, the_search_finds_the_same_entry_as_brute_force) {
  SCOPED_TRACE(oracle::seed_note());
  const int resolution = GetParam();
  test::RandomMasks masks(oracle::test_seed(), resolution);
  for (const int entries : {16, 63, 64, 65, 256, 257, 1000, 4096}) {
    const CompressionLut lut(resolution, masks.many(entries - 1));
    for (const int chunk_bits : {8, entries == 65 ? 1 : entries == 64 ? 5 : entries == 16 ? 13 : 11}) {
      const RequirementLuts search(lut, chunk_bits);
      for (int i = 0; i < 300; ++i) {
        const std::vector<std::uint64_t> mask = masks.one();
        ASSERT_EQ(search.find(mask.data()), lut.tightest(mask.data()))
            << "R " << resolution << ", entries " << lut.entries() << ", b " << chunk_bits << ", mask "
            << test::text(mask);
      }
    }
  }
}

TEST_P(EveryResolution, the_search_from_an_entry_on_finds_the_first_that_holds_the_mask) {
  SCOPED_TRACE(oracle::seed_note());
  const int resolution = GetParam();
  test::RandomMasks masks(oracle::test_seed(), resolution);
  const CompressionLut lut(resolution, masks.many(600));
  const RequirementLuts search(lut);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<std::uint64_t> mask = masks.one();
    const int first = masks.integer(0, lut.entries() - 1);
    int expected = first;
    while (!holds_all(lut.entry(expected), mask.data(), lut.words())) ++expected;
    ASSERT_EQ(search.find(mask.data(), first), expected) << "from " << first << ", mask " << test::text(mask);
  }
}

TEST_P(EveryResolution, an_entry_finds_itself_and_the_full_mask_finds_the_last) {
  SCOPED_TRACE(oracle::seed_note());
  const int resolution = GetParam();
  const CompressionLut lut(resolution, test::RandomMasks(oracle::test_seed(), resolution).many(200));
  const RequirementLuts search(lut);
  for (int e = 0; e < lut.entries(); ++e) ASSERT_EQ(search.find(lut.entry(e)), e);
  EXPECT_EQ(search.find(full_mask(resolution).data()), lut.entries() - 1);
}

INSTANTIATE_TEST_SUITE_P(R, EveryResolution, testing::Range(kMinResolution, kMaxResolution + 1));

TEST(RequirementLuts, given_the_papers_figure_5_then_the_list_of_conservative_masks_is_the_and_of_its_chunks) {
  // Eight cells; 00001111, 01010101 and the full mask. 00000101 is in both of the first two: the one first in order.
  const CompressionLut lut(2, {0x0F, 0x55});
  const RequirementLuts search(lut, 2);
  EXPECT_EQ(search.chunks(), 4);
  const auto found = [&](std::uint64_t mask) { return *lut.entry(search.find(&mask)); };
  EXPECT_EQ(found(0x05), 0x0Fu);
  EXPECT_EQ(found(0x50), 0x55u);
  EXPECT_EQ(found(0x0A), 0x0Fu);
  EXPECT_EQ(found(0x5F), 0xFFu);
}

TEST(RequirementLuts, given_a_lut_of_256_entries_then_their_size_is_chunks_times_patterns_times_entries) {
  const CompressionLut lut(4, test::RandomMasks(1, 4).many(4000));
  const CompressionLut small(4, {lut.bits().begin(), lut.bits().begin() + 255});
  ASSERT_EQ(small.entries(), 256);
  EXPECT_EQ(RequirementLuts(small, 8).bytes(), 8u * 256 * 256 / 8);
}

TEST(RequirementLuts, given_chunks_of_no_bits_or_of_too_many_then_an_error) {
  const CompressionLut lut(4, {});
  EXPECT_THROW(RequirementLuts(lut, 0), Error);
  EXPECT_THROW(RequirementLuts(lut, kMaxChunkBits + 1), Error);
}

}  // namespace
}  // namespace ctu::cull
