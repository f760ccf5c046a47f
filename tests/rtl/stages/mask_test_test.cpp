// rtl/mask_test.sv against model/pipeline/mask_test.h: every handshake, survivor and account in every cycle, with
// tables filled from the model's.
#include <gtest/gtest.h>

#include <string>

#include "VMaskTestBitTable.h"
#include "VMaskTestBitTableCached.h"
#include "VMaskTestBitTableReachable.h"
#include "VMaskTestComparators.h"
#include "VMaskTestComparatorsCompressed.h"
#include "VMaskTestDedup.h"
#include "VMaskTestDedupCached.h"
#include "VMaskTestDedupCompressed.h"
#include "VMaskTestDedupFolded.h"
#include "VMaskTestMaskLut.h"
#include "VMaskTestMaskLutReachable.h"
#include "VMaskTestOneProjection.h"
#include "VMaskTestProjection.h"
#include "VMaskTestProjectionCached.h"
#include "VMaskTestProjectionCompressed.h"
#include "VMaskTestProjectionFolded.h"
#include "VMutantIdNotMirrored.h"
#include "VMutantRowsNotKept.h"
#include "VMutantSecondTurnsForgotten.h"
#include "VMutantUnsharedReads.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/mask_test_twin.h"

namespace ctu::rtl {
namespace {

using cull::Design;
using cull::TableRows;

/// The parameters of a model in mask_test.cmake, as the C++ side says them.
struct Variant {
  Design design;
  cull::MaskOptions options{};
  int banks = 4, ports = 1, latency = 2, second_latency = 1, projection_tables = 3;
  TableRows rows = TableRows::All;
  std::uint32_t distinct = 1270;
  int table_cache_bytes = 0;
  const char* scene = "gen:hair-ball?strands=60";

  pipeline::UnitConfig config(const test::World& world) const {
    pipeline::UnitConfig config = world.config();
    config.mask_test.banks = banks;
    config.mask_test.ports = ports;
    config.mask_test.latency = latency;
    config.mask_test.second_latency = second_latency;
    config.mask_test.projection_tables = projection_tables;
    config.mask_test.rows = rows;
    config.table_cache.bytes = table_cache_bytes;
    config.cell_locate.units = config.comparators.units = 4;  // a node each cycle, so that nodes meet
    return config;
  }
};

/// Runs without refusals and with three kinds of them.
template <class Model>
void expect_equal(const Variant& variant, bool has_conflicts) {
  SCOPED_TRACE(oracle::seed_note());
  const test::World any_rays(variant.scene, variant.design, 150, variant.options);
  // Rays that every kind of rows serves.
  const test::World world(any_rays.tree(), variant.design, rays_from_outside(any_rays), variant.options);
  if (variant.options.entries != 0) {
    ASSERT_EQ(world.image().layout.mask_bits, std::bit_width(static_cast<unsigned>(variant.options.entries - 1)))
        << "MASK_BITS";
  }
  if (variant.design == Design::Dedup) {
    const cull::OnChipTables tables(world.tester(), variant.rows, variant.projection_tables);
    ASSERT_LE(tables.tables()[1].rows, variant.distinct);
  }
  for (const std::uint64_t stall_seed : {0, 1, 2, 3}) {
    SCOPED_TRACE("stall seed " + std::to_string(stall_seed));
    const auto seen = MaskTestTwin<Model>(world, variant.config(world), stall_seed).run();
    ASSERT_EQ(seen.difference, "");
    EXPECT_GT(seen.asked, 200u);
    EXPECT_GT(seen.nodes, seen.asked) << "every node had a question";
    EXPECT_EQ(seen.conflicts > 0, has_conflicts);
    if (stall_seed != 0) {
      EXPECT_GT(seen.blocked, 0u);
    }
  }
}

TEST(RtlMaskTest, projection_tables_for_each_pair_of_axes) {
  expect_equal<VMaskTestProjection>({.design = Design::Projection}, true);
}
TEST(RtlMaskTest, one_projection_table_read_three_times_a_lane) {
  expect_equal<VMaskTestOneProjection>({.design = Design::Projection,
                                        .options = {.ray_resolution = 6},
                                        .banks = 2,
                                        .ports = 3,
                                        .latency = 4,
                                        .projection_tables = 1},
                                       true);
}
TEST(RtlMaskTest, ray_mask_table_in_one_bank) {
  expect_equal<VMaskTestMaskLut>({.design = Design::MaskLut, .banks = 1, .latency = 1}, true);
}
TEST(RtlMaskTest, cells_from_comparators) {
  expect_equal<VMaskTestComparators>({.design = Design::Comparators}, false);
}
TEST(RtlMaskTest, numbered_masks_read_one_memory_behind_the_other) {
  expect_equal<VMaskTestDedup>({.design = Design::Dedup, .banks = 1, .ports = 2, .latency = 1}, true);
}
TEST(RtlMaskTest, numbered_bit_rows) {
  expect_equal<VMaskTestDedupCompressed>({.design = Design::Dedup,
                                          .options = {.resolution = 3, .ray_resolution = 5, .entries = 300},
                                          .banks = 2,
                                          .second_latency = 3,
                                          .distinct = 2500,
                                          .scene = "gen:hair-ball?strands=200"},
                                         true);
}
TEST(RtlMaskTest, bit_table) {
  expect_equal<VMaskTestBitTable>({.design = Design::BitTable, .options = {.entries = 64}, .banks = 2}, true);
}
TEST(RtlMaskTest, projections_over_compressed_masks) {
  expect_equal<VMaskTestProjectionCompressed>(
      {.design = Design::Projection, .options = {.resolution = 6, .ray_resolution = 6, .entries = 256}, .banks = 8},
      true);
}
TEST(RtlMaskTest, comparators_over_compressed_masks) {
  expect_equal<VMaskTestComparatorsCompressed>(
      {.design = Design::Comparators, .options = {.entries = 32}, .banks = 1, .latency = 3}, true);
}
TEST(RtlMaskTest, projections_of_folded_keys_are_mirrored_back) {
  expect_equal<VMaskTestProjectionFolded>(
      {.design = Design::Projection, .options = {.resolution = 3, .ray_resolution = 5}, .rows = TableRows::Folded},
      true);
}
TEST(RtlMaskTest, ray_masks_of_reachable_keys) {
  expect_equal<VMaskTestMaskLutReachable>({.design = Design::MaskLut,
                                           .options = {.ray_resolution = 6},
                                           .banks = 2,
                                           .ports = 2,
                                           .latency = 3,
                                           .rows = TableRows::Reachable},
                                          true);
}
TEST(RtlMaskTest, numbered_masks_are_mirrored_by_key_and_by_number) {
  expect_equal<VMaskTestDedupFolded>(
      {.design = Design::Dedup, .options = {.ray_resolution = 5}, .rows = TableRows::Folded, .distinct = 700}, true);
}
TEST(RtlMaskTest, bit_rows_of_reachable_keys) {
  expect_equal<VMaskTestBitTableReachable>(
      {.design = Design::BitTable, .options = {.ray_resolution = 5, .entries = 64}, .rows = TableRows::Reachable},
      true);
}
TEST(RtlMaskTest, cached_projections_come_with_the_node) {
  expect_equal<VMaskTestProjectionCached>(
      {.design = Design::Projection, .options = {.entries = 64}, .table_cache_bytes = 4096}, false);
}
TEST(RtlMaskTest, cached_numbered_masks_come_with_how_they_are_mirrored) {
  expect_equal<VMaskTestDedupCached>({.design = Design::Dedup,
                                      .options = {.ray_resolution = 5},
                                      .latency = 1,
                                      .rows = TableRows::Folded,
                                      .table_cache_bytes = 4096},
                                     false);
}
TEST(RtlMaskTest, cached_bit_rows_come_as_the_byte_with_the_bit) {
  expect_equal<VMaskTestBitTableCached>({.design = Design::BitTable,
                                         .options = {.ray_resolution = 5, .entries = 64},
                                         .latency = 3,
                                         .rows = TableRows::Reachable,
                                         .table_cache_bytes = 4096},
                                        false);
}
/// A broken twin must differ from the model, with refusals or without.
template <class Model>
void expect_caught(const Variant& variant) {
  const test::World world(variant.scene, variant.design, 100, variant.options);
  const auto difference = MaskTestTwin<Model>(world, variant.config(world), 1).run().difference;
  EXPECT_NE(difference, "");
  testing::Test::RecordProperty("caught", difference);
}

TEST(RtlMaskTestMutants, are_caught) {
  const Variant dedup{.design = Design::Dedup, .banks = 1, .latency = 1, .rows = TableRows::Folded};
  expect_caught<VMutantUnsharedReads>(dedup);
  expect_caught<VMutantRowsNotKept>(dedup);
  expect_caught<VMutantIdNotMirrored>(dedup);
  expect_caught<VMutantSecondTurnsForgotten>(dedup);
}

}  // namespace
}  // namespace ctu::rtl
