// Gates from the committed table are those that synthesis finds, and are not there where the table has none.
#include "sim/energy/gate_area.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/energy/unit_shape.h"

namespace {

using namespace ctu::energy;
using ctu::cull::Design;

/// `ctusim area`, column gate equivalents, as rows `check` of the table have it.
TEST(GateArea, of_whole_units_is_within_half_a_percent_of_synthesis) {
  UnitShape shape;
  const GateArea with = GateTable::standard().of(shape);
  EXPECT_TRUE(with.is_known());
  EXPECT_NEAR(with.gate_equivalents, 1551965, 0.005 * 1551965);
  shape.config.mask_test.design = Design::None;
  const GateArea without = GateTable::standard().of(shape);
  EXPECT_TRUE(without.is_known());
  EXPECT_NEAR(without.gate_equivalents, 987523, 0.005 * 987523);
}

TEST(GateArea, is_said_to_be_unknown_by_stage) {
  const auto unknown = [](const auto& change, const std::string& stage) {
    UnitShape shape;
    change(shape);
    const GateArea area = GateTable::standard().of(shape);
    EXPECT_GT(area.gate_equivalents, 1e5) << "the nearest rows stand for it in a search";
    return std::find(area.unknown.begin(), area.unknown.end(), stage) != area.unknown.end();
  };
  EXPECT_TRUE(unknown([](UnitShape& s) { s.config.triangle_test.latency = 20; }, "triangle_test"));
  EXPECT_TRUE(unknown([](UnitShape& s) { s.config.mask_test.banks = 64; }, "mask_test"));
  EXPECT_TRUE(unknown([](UnitShape& s) { s.config.cell_locate.units = 4; }, "cell_locate"));
  EXPECT_TRUE(unknown([](UnitShape& s) { s.config.node_cache.ports = 2; }, "node_fetch"));
  EXPECT_TRUE(unknown([](UnitShape& s) { s.packet_rays = 16; }, "packet_cull"));
}

TEST(GateArea, shrinks_with_what_a_unit_has) {
  const auto gates = [](const auto& change) {
    UnitShape shape;
    change(shape);
    return GateTable::standard().of(shape).gate_equivalents;
  };
  const double all = gates([](UnitShape&) {});
  EXPECT_LT(gates([](UnitShape& s) { s.config.unit.contexts = 16; }), all);
  EXPECT_LT(gates([](UnitShape& s) { s.config.leaf_cache.mshrs = 4; }), all);
  EXPECT_LT(gates([](UnitShape& s) { s.config.ray_setup.interval = 6; }), all);
  EXPECT_LT(gates([](UnitShape& s) { s.config.stack.entries = 8; }), all);
  EXPECT_GT(gates([](UnitShape& s) { s.spheres = true; }), all + 400000);
}

}  // namespace
