// Counts times table, by hand: what one ray that visits two nodes and a leaf of three triangles takes.
#include "sim/energy/event_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/energy/cost_report.h"
#include "sim/energy/stage_operations.h"
#include "sim/energy/unit_shape.h"

namespace {

using namespace ctu::energy;
using ctu::cull::Design;
using ctu::pipeline::UnitResult;

double pj_of(const std::vector<EnergyItem>& items, const std::string& stage, const std::string& name) {
  for (const EnergyItem& item : items)
    if (item.stage == stage && item.item == name) return item.pj();
  ADD_FAILURE() << "no item " << stage << ": " << name;
  return 0;
}

UnitShape shape_of(Design design) {
  UnitShape shape;
  shape.config.mask_test.design = design;
  if (design == Design::Projection)
    shape.tables = {{"projections xy", 256, 16}, {"projections yz", 256, 16}, {"projections xz", 256, 16}};
  return shape;
}

UnitResult small_run() {
  UnitResult result;
  result.cycles = 1000;
  result.rays = 1;
  result.counts = {.rays = 1, .node_visits = 2, .triangle_tests = 3, .leaf_visits = 1};
  result.counters = {{"node_fetch.lookups", "lines", "", 4},   {"node_fetch.hits", "lines", "", 1},
                     {"node_fetch.fills", "lines", "", 3},     {"memory.node_requests", "lines", "", 3},
                     {"cell_locate.lanes", "lanes", "", 5},    {"mask_test.projections_xy.reads", "reads", "", 4},
                     {"stack.pushes", "entries", "", 2},       {"stack.pops", "entries", "", 2},
                     {"memory.leaf_requests", "lines", "", 1}, {"leaf_fetch.lookups", "lines", "", 1},
                     {"leaf_fetch.fills", "lines", "", 1}};
  return result;
}

TEST(EventEnergy, arithmetic_is_operations_times_the_table) {
  const auto items = event_energy(shape_of(Design::Projection), small_run(), EnergyTable::standard());
  // Four lanes, three axes, four bounds: 48 subtractions and products; 13 comparisons a lane.
  EXPECT_DOUBLE_EQ(pj_of(items, "box_test", "slabs of four boxes"), 2 * (48 * 0.9 + 48 * 3.7 + 52 * 0.21));
  // 3 inner planes on 3 axes, two bounds each: 18 sums of 36 weighted faces; 4 comparisons a plane and 6 more.
  EXPECT_DOUBLE_EQ(pj_of(items, "cell_locate", "cells located"), 5 * (18 * 0.9 + 36 * 0.23 + 42 * 0.21));
  EXPECT_DOUBLE_EQ(pj_of(items, "triangle_test", "triangles"),
                   3 * (19 * 0.9 + 10 * 3.7 + 3 * 7.3 + 3 * 7.6 + 2 * 0.21));
  EXPECT_DOUBLE_EQ(pj_of(items, "ray_queue", "reciprocals and shear"), 6 * 7.3 + 3 * 0.21);
  EXPECT_DOUBLE_EQ(pj_of(items, "child_sort", "order"), 2 * 5 * 0.21);
}

TEST(EventEnergy, accesses_are_bits_times_the_law_of_their_memory) {
  const EnergyTable& table = EnergyTable::standard();
  const auto items = event_energy(shape_of(Design::Projection), small_run(), table);
  // A line of 128 bytes from 64 KiB: eight times the memory that 10 pJ for 64 bits are of.
  EXPECT_NEAR(pj_of(items, "node_fetch", "cache read"), 1024 * 10.0 / 64 * std::sqrt(8.0), 1e-9);
  EXPECT_NEAR(pj_of(items, "node_fetch", "cache written"), 3 * 1024 * 10.0 / 64 * std::sqrt(8.0), 1e-9);
  EXPECT_DOUBLE_EQ(pj_of(items, "memory", "lines of nodes"), 3 * 1024 * 3.92);
  // A bank of 64 rows of 16 bits is as large as the least memory.
  EXPECT_DOUBLE_EQ(pj_of(items, "mask_test", "projections xy read"), 4 * 16 * table.access_pj(1024));
  EXPECT_DOUBLE_EQ(pj_of(items, "traversal_stack", "entries written"), 2 * 64 * table.access_pj(32 * 16 * 64));
}

TEST(EventEnergy, a_unit_without_culling_computes_half_the_bounds_and_asks_no_mask) {
  const auto items = event_energy(shape_of(Design::None), small_run(), EnergyTable::standard());
  EXPECT_DOUBLE_EQ(pj_of(items, "box_test", "slabs of four boxes"), 2 * (24 * 0.9 + 24 * 3.7 + 52 * 0.21));
  for (const EnergyItem& item : items) EXPECT_TRUE(item.stage != "cell_locate" && item.stage != "mask_test");
}

TEST(EventEnergy, comparators_pay_for_pairs_of_cells_instead_of_tables) {
  const auto items = event_energy(shape_of(Design::Comparators), small_run(), EnergyTable::standard());
  EXPECT_DOUBLE_EQ(pj_of(items, "cell_locate", "cells compared"),
                   5 * (18 * 0.9 + 36 * 0.23 + (36 + 96) * 0.21 + 128 * 0.0031));
}

TEST(EventEnergy, a_report_adds_up) {
  const CostReport report = cost_of_run(shape_of(Design::Projection), small_run(), EnergyTable::standard());
  double stages = 0;
  for (const StageEnergy& stage : report.stages()) stages += stage.pj;
  EXPECT_NEAR(stages, report.dynamic_pj(), 1e-9 * stages);
  EXPECT_DOUBLE_EQ(report.pj_per_ray(), report.dynamic_pj() + report.static_pj);
  // 1000 cycles at 500 MHz of 25 nW a bit, and of the gates where they are known.
  const auto bits = report.gate_equivalents ? report.memory_bits : report.on_chip_bits;
  const double nanowatts = double(bits) * 25 + report.gate_equivalents.value_or(0) * 17.4;
  EXPECT_NEAR(report.static_pj, nanowatts * 2e-3, 1e-6 * report.static_pj);
}

TEST(EventEnergy, a_run_without_counters_has_bits_and_no_energy) {
  UnitResult result = small_run();
  result.counters.clear();
  const CostReport report = cost_of_run(shape_of(Design::Projection), result, EnergyTable::standard());
  EXPECT_FALSE(report.has_energy);
  EXPECT_TRUE(report.items.empty());
  EXPECT_GT(report.on_chip_bits, 0u);
}

}  // namespace
