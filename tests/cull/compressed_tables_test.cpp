// `bit-table` and `dedup` beside the table they are made from: the same answer for every key, bit for bit.
#include <gtest/gtest.h>

#include <random>

#include "model/base/error.h"
#include "model/cull/bit_rows.h"
#include "model/cull/bit_table.h"
#include "model/cull/dedup_table.h"
#include "model/cull/mask_test.h"
#include "model/cull/ray_mask_table.h"
#include "tests/cull/cases.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

struct Sizes {
  int r, ray;
};

/// Masks of a few boxes of cells each, as scenes have them.
std::vector<std::uint64_t> random_masks(int resolution, int count, std::mt19937_64& random) {
  const auto pick = [&] { return static_cast<int>(random() % static_cast<unsigned>(resolution)); };
  const int words = words_per_mask(resolution);
  std::vector<std::uint64_t> masks(static_cast<std::size_t>(count * words));
  for (int i = 0; i < count; ++i)
    for (int boxes = 1 + i % 3; boxes > 0; --boxes) {
      const int from[3] = {pick(), pick(), pick()}, to[3] = {pick(), pick(), pick()};
      for (int z = std::min(from[2], to[2]); z <= std::max(from[2], to[2]); ++z)
        for (int y = std::min(from[1], to[1]); y <= std::max(from[1], to[1]); ++y)
          for (int x = std::min(from[0], to[0]); x <= std::max(from[0], to[0]); ++x) {
            const int bit = cell_bit(resolution, x, y, z);
            masks[static_cast<std::size_t>(i * words + bit / 64)] |= std::uint64_t{1} << (bit % 64);
          }
    }
  return masks;
}

bool share(const std::uint64_t* a, const std::uint64_t* b, int words) {
  for (int w = 0; w < words; ++w)
    if ((a[w] & b[w]) != 0) return true;
  return false;
}

class CompressedTables : public testing::TestWithParam<Sizes> {};

TEST_P(CompressedTables, answer_every_key_and_entry_as_the_masks_do) {
  SCOPED_TRACE(oracle::seed_note());
  std::mt19937_64 random(oracle::test_seed());
  const auto [r, ray] = GetParam();
  const CompressionLut lut(r, random_masks(r, 90, random));
  const RayMaskTable masks(r, ray);
  const BitTable bits(lut, ray);
  const DedupTable dedup(r, ray, nullptr), dedup_bits(r, ray, &lut);
  ASSERT_EQ(bits.rows(), masks.rows());
  ASSERT_EQ(dedup.distinct(), dedup_bits.distinct());
  for (std::uint32_t number = 0; number < masks.rows(); ++number) {
    SCOPED_TRACE(number);
    const std::uint64_t* mask = masks.row(number);
    ASSERT_EQ(key_number(numbered_key(number, ray), ray), number);
    ASSERT_TRUE(std::equal(mask, mask + masks.words(), dedup.row(dedup.id(number))));
    const std::uint64_t* row = bits.row(number);
    ASSERT_TRUE(std::equal(row, row + words_of_bit_row(lut.entries()), dedup_bits.row(dedup_bits.id(number))));
    for (int entry = 0; entry < lut.entries(); ++entry)
      ASSERT_EQ(bit_of_row(row, static_cast<std::uint32_t>(entry)), share(mask, lut.entry(entry), masks.words()));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Resolutions, CompressedTables,
    testing::Values(Sizes{2, 2}, Sizes{2, 5}, Sizes{3, 3}, Sizes{3, 4}, Sizes{4, 4}, Sizes{4, 5}, Sizes{5, 5},
                    Sizes{6, 6}),
    [](const auto& info) {
      std::string name = "R";
      return name.append(std::to_string(info.param.r)).append("_Rray").append(std::to_string(info.param.ray));
    });

TEST(DedupTable, distinct_masks_are_the_published_ones) {
  EXPECT_EQ(DedupTable(4, 4, nullptr).distinct(), 1270u);
  EXPECT_EQ(DedupTable(4, 8, nullptr).distinct(), 20770u);
}

/// Testers of every design for one R and R_ray, the first of them `mask-lut`.
struct Testers {
  std::shared_ptr<const CompressionLut> lut;
  std::vector<MaskTester> of;
};

const std::vector<Testers>& testers() {
  static const std::vector<Testers> all = [] {
    std::mt19937_64 random(oracle::test_seed());
    std::vector<Testers> made;
    for (const Sizes s : {Sizes{2, 3}, Sizes{4, 4}, Sizes{4, 6}, Sizes{4, 8}, Sizes{6, 7}}) {
      const MaskOptions options{.resolution = s.r, .ray_resolution = s.ray};
      Testers testers{std::make_shared<const CompressionLut>(s.r, random_masks(s.r, 60, random)), {}};
      for (const Design design : {Design::MaskLut, Design::Projection, Design::Dedup}) {
        testers.of.emplace_back(design, options);
        testers.of.emplace_back(design, options, testers.lut);
      }
      testers.of.emplace_back(Design::BitTable, options, testers.lut);
      made.push_back(std::move(testers));
    }
    return made;
  }();
  return all;
}

class DesignsAgree : public testing::TestWithParam<test::Family> {};

TEST_P(DesignsAgree, on_pass_uncertain_and_key_of_any_ray_with_masks_compressed_or_not) {
  SCOPED_TRACE(oracle::seed_note());
  test::CaseMaker make(oracle::test_seed());
  for (const Testers& testers : testers())
    for (int i = 0; i < 1000; ++i) {
      const test::RayAndBox c = make.ray_and_box(GetParam());
      const intersect::PreparedRay ray = intersect::prepare_ray(c.ray);
      if (!ray.valid) continue;
      const intersect::Box4 boxes = test::box_in_lane_0(c.lo, c.hi);
      const intersect::SlabTimes times = intersect::slab_test(ray, boxes, c.ray.tmax);
      const CompressionLut& lut = *testers.lut;
      const std::uint16_t index[4] = {static_cast<std::uint16_t>(make.integer(0, lut.entries() - 1))};
      std::vector<std::uint64_t> objects(static_cast<std::size_t>(4 * lut.words()));
      std::copy_n(lut.entry(index[0]), lut.words(), objects.begin());
      const MaskTestResult expected = testers.of[0].test(ray, times, boxes, {objects.data(), index});
      for (const MaskTester& tester : testers.of) {
        const MaskTestResult result = tester.test(ray, times, boxes, {objects.data(), index});
        ASSERT_EQ(result.pass, expected.pass) << to_string(tester.design()) << ": " << test::text(c);
        ASSERT_EQ(result.uncertain, expected.uncertain) << to_string(tester.design()) << ": " << test::text(c);
        ASSERT_EQ(result.key[0], expected.key[0]) << to_string(tester.design()) << ": " << test::text(c);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Families, DesignsAgree, testing::ValuesIn(test::families()),
                         [](const auto& info) { return test::identifier(info.param); });

/// The place and the remedy of the error that `make` must throw.
template <class Make>
void expect_refused(Make&& make, const std::string& where, const std::string& remedy) {
  try {
    make();
    FAIL() << "no error names " << where;
  } catch (const Error& error) {
    EXPECT_NE(error.where().find(where), std::string::npos) << error.what();
    EXPECT_NE(error.remedy().find(remedy), std::string::npos) << error.what();
  }
}

TEST(TableRefusals, say_what_is_missing_or_too_large_before_any_work) {
  expect_refused([] { MaskTester(Design::BitTable, {}); }, "bit-table", "--compress");
  const auto lut = std::make_shared<const CompressionLut>(4, std::vector<std::uint64_t>{1, 2, 3});
  expect_refused([&] { MaskTester(Design::Projection, {.resolution = 5, .ray_resolution = 5}, lut); }, "LUT", "R = 5");
  expect_refused([&] { MaskTester(Design::BitTable, {.ray_resolution = 24}, lut); }, "R_ray = 24", "projection");
  expect_refused([] { MaskTester(Design::Dedup, {.ray_resolution = 24}); }, "R_ray = 24", "projection");
  expect_refused([] { MaskTester(Design::MaskLut, {.ray_resolution = 24}); }, "R_ray = 24", "projection");
}

}  // namespace
}  // namespace ctu::cull
