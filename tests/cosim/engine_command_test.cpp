// `ctusim run --engine rtl|both` from the outside: what it ends with.
#include <gtest/gtest.h>

#include "tests/sim/program.h"

namespace {

using ctu::test::Outcome;
using ctu::test::run_program;
using ctu::test::ScratchFolder;

class EngineCommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    const Outcome outcome =
        ctusim("record 'gen:hair-ball?strands=50&seed=7' -o hair.ctut --size 12x12 --rays diffuse --bounces 1");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static Outcome ctusim(const std::string& arguments) { return run_program(folder_->path(), arguments); }

  static ScratchFolder* folder_;
};
ScratchFolder* EngineCommandTest::folder_ = nullptr;

TEST_F(EngineCommandTest, the_unit_in_gates_returns_every_ray_alone_and_beside_the_model) {
  for (const std::string engine : {"rtl", "both"}) {
    const Outcome outcome = ctusim("run hair.ctut --engine " + engine);
    EXPECT_EQ(outcome.exit_code, 0) << engine << "\n" << outcome.out << outcome.err;
  }
}

TEST_F(EngineCommandTest, rays_in_packets_run_on_the_build_that_has_packet_cull) {
  ASSERT_EQ(ctusim("record 'gen:hair-ball?strands=50&seed=7' -o together.ctut --size 12x12 --rays primary --packets 16")
                .exit_code,
            0);
  for (const std::string engine : {"rtl", "both"}) {
    const Outcome outcome = ctusim("run together.ctut --engine " + engine);
    EXPECT_EQ(outcome.exit_code, 0) << engine << "\n" << outcome.out << outcome.err;
    EXPECT_NE(outcome.out.find("packet_cull"), std::string::npos) << outcome.out;
    const Outcome refused = ctusim("run together.ctut --set mask_test.design=none --engine " + engine);
    EXPECT_EQ(refused.exit_code, 2) << engine << "\n" << refused.out;
    EXPECT_NE(refused.err.find("rays in packets false instead of true"), std::string::npos) << refused.err;
  }
}

TEST_F(EngineCommandTest, rays_that_walk_local_trees_run_in_gates) {
  ASSERT_EQ(ctusim("record 'gen:foliage?twigs=40' -o trees.ctut --size 160x120 --rays shadow --trees 2").exit_code, 0);
  for (const std::string engine : {"rtl", "both"}) {
    const Outcome outcome = ctusim("run trees.ctut --engine " + engine);
    EXPECT_EQ(outcome.exit_code, 0) << engine << "\n" << outcome.out << outcome.err;
    EXPECT_NE(outcome.out.find("wrong hits              0"), std::string::npos) << outcome.out;
    const Outcome refused = ctusim("run trees.ctut --set mask_test.design=none --engine " + engine);
    EXPECT_EQ(refused.exit_code, 2) << engine << "\n" << refused.out;
    EXPECT_NE(refused.err.find("trees up to 1 instead of"), std::string::npos) << refused.err;
  }
}

TEST_F(EngineCommandTest, leaves_that_the_unit_does_not_keep_whole_are_refused) {
  const std::string scene = "record 'gen:hair-ball?strands=50&seed=7' -o large.ctut --size 4x4 --rays primary ";
  // Nothing is split, so leaves of eight triangles are the rule; and two triangles of 128 bytes are 256.
  for (const std::string options : {"--leaf 8 --triangle-cost 0.01", "--triangle-align 128"}) {
    ASSERT_EQ(ctusim(scene + options).exit_code, 0) << options;
    for (const std::string engine : {"rtl", "both"}) {
      const Outcome outcome = ctusim("run large.ctut --engine " + engine);
      EXPECT_EQ(outcome.exit_code, 2) << options << "\n" << outcome.out << outcome.err;
      EXPECT_NE(outcome.err.find("bytes of a leaf up to 160"), std::string::npos) << options << "\n" << outcome.err;
    }
  }
}

TEST_F(EngineCommandTest, a_unit_without_progress_ends_with_exit_code_3) {
  for (const std::string engine : {"rtl", "both"}) {
    // No link moves between two rays that are returned.
    const Outcome outcome =
        ctusim("run hair.ctut --set result.interval=1000 --set watchdog.cycles=600 --engine " + engine);
    EXPECT_EQ(outcome.exit_code, 3) << engine << "\n" << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find("deadlock"), std::string::npos) << outcome.err;
  }
}

}  // namespace
