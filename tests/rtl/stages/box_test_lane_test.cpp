// rtl/box_test_lane.sv against intersect::slab_test: all bounds, t0, t1 and hit, bit for bit, in their cycle.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "VBoxTestLane.h"
#include "VMutantOpenSlab.h"
#include "VMutantReciprocalByDirection.h"
#include "VMutantUnmirroredPlanes.h"
#include "VMutantZeroDistance.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/verilated_lane.h"

namespace ctu::rtl {
namespace {

TEST(BoxTestLane, gives_the_bits_of_the_slab_test_eleven_cycles_later_with_inner_bounds_and_without) {
  SCOPED_TRACE(oracle::seed_note());
  const int cases = std::getenv("CTU_LONG_TESTS") ? 1'000'000 : 50'000;
  VerilatedLane<VBoxTestLane> lane;
  const LaneRun run = lane.run(oracle::test_seed(), cases);
  EXPECT_EQ(run.difference, "") << "after " << run.compared << " boxes";
  EXPECT_GT(run.compared, 3.9 * cases);
  EXPECT_GT(run.hits, run.compared / 50);
  EXPECT_LT(run.hits, run.compared / 2);
}

template <class Model>
void expect_caught() {
  SCOPED_TRACE(oracle::seed_note());
  VerilatedLane<Model> lane;
  const LaneRun run = lane.run(oracle::test_seed(), 20'000);
  EXPECT_NE(run.difference, "");
  std::cout << "box " << run.compared << ", " << run.difference << '\n';
}

TEST(BoxTestLaneMutants, a_reciprocal_chosen_without_a_look_at_the_distance_is_caught) {
  expect_caught<VMutantReciprocalByDirection>();
}
TEST(BoxTestLaneMutants, a_zero_distance_times_an_infinite_reciprocal_is_caught) {
  expect_caught<VMutantZeroDistance>();
}
TEST(BoxTestLaneMutants, near_and_far_planes_not_exchanged_are_caught) { expect_caught<VMutantUnmirroredPlanes>(); }
TEST(BoxTestLaneMutants, a_slab_without_its_faces_for_rays_that_stand_still_is_caught) {
  expect_caught<VMutantOpenSlab>();
}

}  // namespace
}  // namespace ctu::rtl
