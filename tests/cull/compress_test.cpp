// What compression may do to masks, whatever the selection: only add cells, and never cost less than before.
#include "model/cull/compress.h"

#include <gtest/gtest.h>

#include "model/accel/build.h"
#include "model/accel/statistics.h"
#include "model/base/error.h"
#include "model/cull/mask_words.h"
#include "model/cull/sah_masked.h"
#include "model/scene/load.h"
#include "tests/cull/cases.h"

namespace ctu::cull {
namespace {

constexpr Selection kSelections[] = {Selection::TopPerNode, Selection::TopSummed, Selection::Refined};

const accel::Bvh4& hair() {
  static const accel::Bvh4 bvh = accel::build(scene::load("gen:hair-ball?strands=300").mesh, {});
  return bvh;
}

std::string described(const MaskOptions& options) {
  return "R " + std::to_string(options.resolution) + ", entries " + std::to_string(options.entries) + ", " +
         std::string(to_string(options.selection));
}

/// Calls `body(options, masks)` for resolutions, selections and sizes.
template <class Body>
void for_all_options(Body&& body) {
  for (const int resolution : {2, 3, 4, 6, 8}) {
    const ObjectMasks masks = build_object_masks(hair(), {.resolution = resolution}, 2);
    for (const Selection selection : kSelections)
      for (const int entries : {16, 256}) {
        const MaskOptions options{.resolution = resolution, .entries = entries, .selection = selection};
        SCOPED_TRACE(described(options));
        body(options, masks);
      }
  }
}

TEST(Compress, every_replaced_mask_holds_the_original_and_is_the_tightest_entry_that_does) {
  for_all_options([](const MaskOptions& options, const ObjectMasks& masks) {
    const CompressedMasks compressed = compress(hair(), masks, options, 1);
    for (std::uint32_t node = 0; node < hair().nodes.size(); ++node)
      for (int lane = 0; lane < intersect::kLanes; ++lane) {
        const std::uint64_t* was = masks.mask(node, lane);
        const std::uint64_t* is = compressed.masks.mask(node, lane);
        const int index = compressed.masks.of(node).index[lane];
        if (hair().nodes[node].child[lane] == accel::kEmptyChild) {
          ASSERT_EQ(index, 0);
          ASSERT_EQ(count_bits(is, masks.words), 0);
          continue;
        }
        ASSERT_TRUE(holds_all(is, was, masks.words)) << "node " << node << ", lane " << lane;
        ASSERT_TRUE(std::equal(is, is + masks.words, compressed.lut.entry(index)));
        ASSERT_EQ(index, compressed.lut.tightest(was)) << "node " << node << ", lane " << lane;
      }
  });
}

TEST(Compress, the_last_entry_is_full_and_there_are_no_more_entries_than_asked_for) {
  for_all_options([](const MaskOptions& options, const ObjectMasks& masks) {
    const CompressionLut lut = compress(hair(), masks, options, 1).lut;
    EXPECT_LE(lut.entries(), options.entries);
    EXPECT_EQ(lut.set_bits(lut.entries() - 1), options.resolution * options.resolution * options.resolution);
  });
}

TEST(Compress, the_result_is_the_same_for_any_number_of_threads) {
  for_all_options([](const MaskOptions& options, const ObjectMasks& masks) {
    const CompressedMasks one = compress(hair(), masks, options, 1), three = compress(hair(), masks, options, 3);
    EXPECT_EQ(one.lut.bits(), three.lut.bits());
    EXPECT_EQ(one.masks.index, three.masks.index);
    EXPECT_EQ(one.masks.bits, three.masks.bits);
  });
}

TEST(Compress, it_never_lowers_the_masked_surface_area_heuristic_and_never_raises_it_above_that_without_masks) {
  const double plain = accel::statistics(hair()).sah_cost;
  for_all_options([&](const MaskOptions& options, const ObjectMasks& masks) {
    const double before = sah_masked(hair(), masks);
    const double after = sah_masked(hair(), compress(hair(), masks, options, 1).masks);
    EXPECT_LE(before, after);
    EXPECT_LE(after, plain * (1 + 1e-12));
  });
}

TEST(Compress, given_a_place_for_every_different_mask_then_nothing_changes) {
  const ObjectMasks masks = build_object_masks(hair(), {.resolution = 2}, 1);
  for (const Selection selection : kSelections) {
    const CompressedMasks compressed =
        compress(hair(), masks, {.resolution = 2, .entries = 256, .selection = selection}, 1);
    EXPECT_EQ(compressed.masks.bits, masks.bits) << to_string(selection);
  }
}

TEST(Compress, given_a_tree_without_nodes_then_the_lut_is_the_full_mask) {
  const accel::Bvh4 empty;
  for (const Selection selection : kSelections) {
    const MaskOptions options{.entries = 16, .selection = selection};
    EXPECT_EQ(compress(empty, build_object_masks(empty, options, 1), options, 1).lut.entries(), 1);
  }
}

TEST(Compress, given_too_few_or_too_many_entries_then_an_error) {
  const ObjectMasks masks = build_object_masks(hair(), {}, 1);
  EXPECT_THROW(compress(hair(), masks, {.entries = 15}, 1), Error);
  EXPECT_THROW(compress(hair(), masks, {.entries = 4097}, 1), Error);
}

TEST(SahMasked, given_full_masks_then_it_is_the_surface_area_heuristic) {
  ObjectMasks masks = build_object_masks(hair(), {}, 1);
  for (std::uint64_t& word : masks.bits) word = ~std::uint64_t{0};
  const double plain = accel::statistics(hair(), 1.5, 0.5).sah_cost;
  EXPECT_NEAR(sah_masked(hair(), masks, {1.5, 0.5}), plain, 1e-12 * plain);
}

TEST(SahMasked, given_one_leaf_then_it_is_the_closed_form) {
  // Two triangles in the root's only child: C_T + C_I * 2 * set cells / 64.
  const accel::Bvh4 bvh = test::one_leaf({{{0, 0, 0}, {4, 0, 0}, {0, 2, 1}, 0}, {{4, 0, 0}, {4, 2, 3}, {0, 2, 1}, 1}});
  const ObjectMasks masks = build_object_masks(bvh, {}, 1);
  const double cells = count_bits(masks.mask(0, 0), 1);
  const double expected = 3 + 5 * 2 * cells / 64;
  EXPECT_NEAR(sah_masked(bvh, masks, {3, 5}), expected, 1e-12 * expected);
}

}  // namespace
}  // namespace ctu::cull
