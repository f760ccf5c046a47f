// A ray that needs a row which mask_test.rows = reachable leaves out ends the run of the unit in gates.
#include <gtest/gtest.h>

#include "model/base/error.h"
#include "sim/cosim/rtl_builds.h"
#include "sim/cosim/rtl_result.h"
#include "tests/cosim/grid_configs.h"
#include "tests/pipeline/world.h"

namespace ctu::cosim {
namespace {

constexpr const char* kSettings =
    "unit.contexts=4 node_cache.bytes=512 leaf_cache.bytes=512 table_cache.bytes=256 stack.spill_batch=4";

TEST(RowLeftOut, ends_the_run_and_names_the_ray) {
  const auto unit = load_rtl_unit(CTU_RTL_FOLDER "/dedup-cached.so");
  // Begins and ends in inner cells of the box, which no ray from outside does.
  intersect::Ray inside = test::ray_through_leaves();
  inside.origin[2] = 1.5f;
  inside.tmax = 1;
  const test::World world(test::stacked_leaves(1, 1), cull::Design::Dedup, {test::ray_through_leaves(), inside});
  const pipeline::UnitConfig config = unit_config(unit->parameters(), kSettings);
  test::VectorFeed feed(world.blocks());
  const pipeline::Work work{world.image(), world.tester(), feed};
  ASSERT_EQ(misfit(unit->parameters(), config, work), "");
  try {
    run_rtl(*unit, config, work, {});
    FAIL() << "answered";
  } catch (const Error& error) {
    EXPECT_EQ(error.where().substr(0, 5), "ray 1");
    EXPECT_NE(error.remedy().find("mask_test.rows = folded"), std::string::npos);
  }
}

TEST(RowLeftOut, not_for_rays_from_outside) {
  const auto unit = load_rtl_unit(CTU_RTL_FOLDER "/dedup-cached.so");
  const test::World world(test::stacked_leaves(1, 1), cull::Design::Dedup, {test::ray_through_leaves()});
  test::VectorFeed feed(world.blocks());
  const auto result =
      run_rtl(*unit, unit_config(unit->parameters(), kSettings), {world.image(), world.tester(), feed}, {});
  EXPECT_EQ(result.rays, 1u);
  EXPECT_EQ(result.wrong_hits, 0u);
}

}  // namespace
}  // namespace ctu::cosim
