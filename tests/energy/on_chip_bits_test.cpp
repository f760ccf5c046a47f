// Bits on chip in closed form are those that synthesis finds: `ctusim area` with the options named at each case.
#include "sim/energy/on_chip_bits.h"

#include <gtest/gtest.h>

#include <map>

#include "sim/energy/unit_shape.h"

namespace {

using namespace ctu::energy;
using ctu::cull::Design;

std::map<std::string, std::uint64_t> memory_bits(const UnitShape& shape) {
  std::map<std::string, std::uint64_t> stages;
  for (const Structure& structure : on_chip_structures(shape))
    if (structure.keeping == Keeping::Memory) stages[structure.stage] += structure.bits;
  return stages;
}

UnitShape default_shape() {
  UnitShape shape;
  shape.tables = {{"projections xy", 256, 16}, {"projections yz", 256, 16}, {"projections xz", 256, 16}};
  return shape;
}

// ctusim area
TEST(OnChipBits, are_those_of_synthesis_for_the_default_unit) {
  const std::map<std::string, std::uint64_t> synthesised = {
      {"context_file", 79136}, {"leaf_fetch", 642208}, {"mask_test", 12288},      {"node_fetch", 679200},
      {"ray_queue", 160},      {"scheduler", 2368},    {"traversal_stack", 33280}};
  EXPECT_EQ(memory_bits(default_shape()), synthesised);
  EXPECT_EQ(bits_of(on_chip_structures(default_shape()), Keeping::Memory), 1448640u);
}

// ctusim area, row link: flip-flops
TEST(OnChipBits, of_links_are_the_flip_flops_that_synthesis_finds) {
  std::uint64_t bits = 0;
  for (const Structure& structure : on_chip_structures(default_shape()))
    if (structure.stage == "link") bits += structure.bits;
  EXPECT_EQ(bits, 9540u);
}

TEST(OnChipBits, go_with_contexts_caches_and_stack) {
  const UnitShape shape = default_shape();
  UnitShape fewer = shape;
  fewer.config.unit.contexts = 16;
  const auto all = memory_bits(shape), half = memory_bits(fewer);
  // A context's number is a bit shorter, so the small queues shrink to less than half.
  EXPECT_EQ(half.at("context_file") * 2, all.at("context_file"));
  EXPECT_LT(half.at("ray_queue") * 2, all.at("ray_queue"));
  UnitShape bare = shape;
  bare.config.node_cache.bytes = 0;
  EXPECT_EQ(memory_bits(bare).at("node_fetch"), all.at("node_fetch") - 65536 * 8 - 512 * 33 - 128 * 12);
  UnitShape shallow = shape;
  shallow.config.stack.entries = 8;
  EXPECT_EQ(all.at("traversal_stack") - memory_bits(shallow).at("traversal_stack"), 32u * 8 * 64);
}

// ctusim area --trees 9
TEST(OnChipBits, of_several_trees_are_their_roots_and_those_of_contexts) {
  UnitShape shape = default_shape();
  shape.trees = 9;
  EXPECT_EQ(memory_bits(shape).at("context_file"), 80160u);
  EXPECT_EQ(memory_bits(shape).at("ray_queue"), 448u);
}

TEST(OnChipBits, of_tables_in_memory_are_their_cache_and_the_rows_of_contexts) {
  UnitShape shape = default_shape();
  shape.config.table_cache.bytes = 4096;
  const auto bits = memory_bits(shape);
  EXPECT_FALSE(bits.contains("mask_test"));
  EXPECT_EQ(bits.at("table_fetch"), 4096u * 8 + 32 * 33 + 8 * 12 + 32 * 5 + 32 * 20);
}

TEST(OnChipBits, what_a_scene_does_not_need_takes_none) {
  UnitShape shape = default_shape();
  const std::uint64_t all = bits_of(on_chip_structures(shape));
  shape.config.mask_test.design = Design::None;
  shape.tables.clear();
  const auto bits = memory_bits(shape);
  EXPECT_FALSE(bits.contains("mask_test"));
  // Slab times and keys of 32 contexts, masks of 256 bits in node and line, less the four that stand for none.
  EXPECT_EQ(bits.at("context_file"), 32u * (173 + 256 + 128 + 128));
  shape.spills = false;
  EXPECT_LT(bits_of(on_chip_structures(shape)), all);
  UnitShape spheres = default_shape();
  spheres.spheres = true;
  EXPECT_EQ(memory_bits(spheres).at("context_file") - memory_bits(default_shape()).at("context_file"), 32u * 96);
}

}  // namespace
