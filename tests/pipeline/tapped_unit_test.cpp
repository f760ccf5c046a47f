// The watched unit is the unit: the same cycles, events and accounts, with and without refusals.
#include <gtest/gtest.h>

#include "model/pipeline/tapped_unit.h"
#include "tests/pipeline/world.h"

namespace ctu::test {
namespace {

void expect_same_run(std::uint64_t stall_seed) {
  World world("gen:hair-ball?strands=60", cull::Design::Projection, 100);
  VectorFeed feed(world.blocks());
  pipeline::TappedUnit unit(world.config(), {world.image(), world.tester(), feed}, {.seed = stall_seed});
  while (!unit.done()) unit.step();
  const pipeline::UnitResult plain =
      world.run(world.config(), {.exec = true, .skip_idle = false, .backpressure = {.seed = stall_seed}});
  const pipeline::UnitResult watched = unit.result();
  EXPECT_EQ(watched.cycles, plain.cycles);
  EXPECT_EQ(watched.event_log_hash, plain.event_log_hash);
  EXPECT_EQ(watched.wrong_hits, 0u);
  ASSERT_EQ(watched.stages.size(), plain.stages.size());
  for (std::size_t i = 0; i < plain.stages.size(); ++i) EXPECT_EQ(watched.stages[i].busy, plain.stages[i].busy);
}

TEST(TappedUnit, RunsAsThePlainUnit) { expect_same_run(0); }
TEST(TappedUnit, RunsAsThePlainUnitUnderRefusals) { expect_same_run(7); }

}  // namespace
}  // namespace ctu::test
