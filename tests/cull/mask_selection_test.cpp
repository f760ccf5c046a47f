// How the entries of a compression LUT are chosen: the paper's ranking by hand, and what the refined selection
// promises.
#include "model/cull/mask_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "model/accel/build.h"
#include "model/cull/compress.h"
#include "model/cull/distinct_masks.h"
#include "model/cull/mask_refinement.h"
#include "model/cull/mask_sample.h"
#include "model/cull/mask_words.h"
#include "model/cull/sah_masked.h"
#include "model/scene/load.h"
#include "tests/cull/random_masks.h"
#include "tests/oracle/seed.h"

namespace ctu::cull {
namespace {

/// Masks of R = 2 with the given bits, one a child.
ObjectMasks small_masks(const std::vector<std::uint64_t>& bits) {
  ObjectMasks masks;
  masks.resolution = 2;
  masks.bits = bits;
  return masks;
}

bool has(const CompressionLut& lut, std::uint64_t mask) {
  return std::find(lut.bits().begin(), lut.bits().end(), mask) != lut.bits().end();
}

TEST(MaskSelection, given_a_mask_that_is_light_but_frequent_then_only_summed_importance_takes_it) {
  // Sixteen masks of two cells and weight 2 fill the fifteen places beside the full mask; 0xC1 has three cells and
  // weight 1, twice: 3 and 3 against 4 for each node, 6 when summed.
  std::vector<std::uint64_t> bits{0xC1, 0xC1};
  ChildWeights weights{1, 1};
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8 && bits.size() < 18; ++b) {
      bits.push_back((std::uint64_t{1} << a) | (std::uint64_t{1} << b));
      weights.push_back(2);
    }
  const ObjectMasks masks = small_masks(bits);
  const CompressionLut per_node = select_masks(masks, weights, Selection::TopPerNode, 16);
  const CompressionLut summed = select_masks(masks, weights, Selection::TopSummed, 16);
  EXPECT_EQ(per_node.entries(), 16);
  EXPECT_EQ(summed.entries(), 16);
  EXPECT_FALSE(has(per_node, 0xC1));
  EXPECT_TRUE(has(summed, 0xC1));
  EXPECT_FALSE(has(per_node, bits.back()));  // of equal importance the first in the tree are taken
}

TEST(MaskSelection, equal_masks_take_one_place_and_children_without_weight_none) {
  const CompressionLut lut =
      select_masks(small_masks({0x03, 0x03, 0x0C, 0x30, 0xFF}), {1, 1, 1, 0, 1}, Selection::TopPerNode, 16);
  EXPECT_EQ(lut.bits(), (std::vector<std::uint64_t>{0x03, 0x0C, 0xFF}));
}

/// The cost that the tightest entry adds, by brute force.
double added_cells(const DistinctMasks& masks, const CompressionLut& lut) {
  double cost = 0;
  for (std::size_t i = 0; i < masks.size(); ++i)
    cost += masks.sum[i] * (lut.set_bits(lut.tightest(masks.mask(i))) - count_bits(masks.mask(i), masks.words));
  return cost;
}

TEST(MaskRefinement, it_never_costs_more_than_what_it_starts_from_and_keeps_to_the_number_of_entries) {
  SCOPED_TRACE(oracle::seed_note());
  for (int resolution = kMinResolution; resolution <= kMaxResolution; ++resolution) {
    test::RandomMasks random(oracle::test_seed() + static_cast<std::uint64_t>(resolution), resolution);
    ObjectMasks masks;
    masks.resolution = resolution;
    masks.words = words_per_mask(resolution);
    masks.bits = random.many(1500);
    ChildWeights weights(1500);
    for (double& weight : weights) weight = random.integer(1, 1000);
    const DistinctMasks distinct = distinct_masks(masks, weights);
    for (const int entries : {16, 100}) {
      const CompressionLut start = select_masks(masks, weights, Selection::TopSummed, entries);
      const CompressionLut refined(resolution, refine_masks(resolution, distinct, start.bits(), entries));
      EXPECT_LE(refined.entries(), entries) << "R " << resolution;
      EXPECT_LE(added_cells(distinct, refined), added_cells(distinct, start) * (1 + 1e-9)) << "R " << resolution;
    }
  }
}

TEST(MaskRefinement, given_groups_of_like_masks_that_are_as_many_as_the_entries_then_it_finds_their_unions) {
  // Each group: a box of 2x2x2 cells without one of its eight. The union is the box, which no mask of the group is.
  DistinctMasks masks;
  std::vector<std::uint64_t> boxes;
  for (int corner = 0; corner < 8; ++corner) {
    std::uint64_t box = 0;
    std::array<int, 8> cells{};
    for (int i = 0; i < 8; ++i) {
      cells[static_cast<std::size_t>(i)] =
          cell_bit(4, 2 * (corner & 1) + (i & 1), 2 * (corner >> 1 & 1) + (i >> 1 & 1), 2 * (corner >> 2) + (i >> 2));
      box |= std::uint64_t{1} << cells[static_cast<std::size_t>(i)];
    }
    boxes.push_back(box);
    for (const int cell : cells) {
      masks.bits.push_back(box & ~(std::uint64_t{1} << cell));
      masks.sum.push_back(1);
      masks.largest.push_back(1);
    }
  }
  const CompressionLut refined(4, refine_masks(4, masks, {masks.bits.begin(), masks.bits.begin() + 8}, 9));
  for (const std::uint64_t box : boxes) EXPECT_TRUE(has(refined, box)) << test::text({box});
}

TEST(MaskSample, its_weights_add_up_to_what_compression_can_cost_at_most) {
  const accel::Bvh4 bvh = accel::build(scene::load("gen:hair-ball?strands=1000").mesh, {});
  const ObjectMasks masks = build_object_masks(bvh, {}, 2);
  const ChildWeights weights = sah_weights(bvh);
  const auto stake = [](const DistinctMasks& some) {
    double sum = 0;
    for (std::size_t i = 0; i < some.size(); ++i) sum += some.sum[i] * (64 - count_bits(some.mask(i), 1));
    return sum;
  };
  const double all = stake(distinct_masks(masks, weights));
  for (const std::size_t enough : {200, 1000, 100000}) {
    const DistinctMasks sample = sample_masks(masks, weights, enough);
    EXPECT_GE(sample.size(), std::min<std::size_t>(enough, 2000));
    EXPECT_NEAR(stake(sample), all, 0.001 * all) << enough;
  }
}

/// Eq. 2 of a hair ball with a table of so many entries, relative to masks as they are.
double relative_cost(const accel::Bvh4& bvh, const ObjectMasks& masks, Selection selection, int entries) {
  const MaskOptions options{.resolution = masks.resolution, .entries = entries, .selection = selection};
  return sah_masked(bvh, compress(bvh, masks, options, 2).masks) / sah_masked(bvh, masks);
}

TEST(Refined, it_costs_less_by_the_masked_heuristic_than_the_papers_selections_and_less_with_more_entries) {
  for (const char* name : {"gen:hair-ball?strands=500", "gen:foliage?twigs=100", "gen:tilted-quads?quads=1500"}) {
    const accel::Bvh4 bvh = accel::build(scene::load(name).mesh, {});
    for (const int resolution : {4, 6}) {
      const ObjectMasks masks = build_object_masks(bvh, {.resolution = resolution}, 2);
      double before = 1e9;
      for (const int entries : {16, 64, 256, 1024}) {
        const double refined = relative_cost(bvh, masks, Selection::Refined, entries);
        EXPECT_LE(refined, relative_cost(bvh, masks, Selection::TopSummed, entries)) << name << entries;
        EXPECT_LE(refined, relative_cost(bvh, masks, Selection::TopPerNode, entries)) << name << entries;
        EXPECT_LE(refined, before * 1.005) << name << entries;  // a search, not an optimum
        before = refined;
      }
    }
  }
}

}  // namespace
}  // namespace ctu::cull
