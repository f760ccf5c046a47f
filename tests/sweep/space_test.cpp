// A space as it is written: what it becomes, what is left out of it, and what is refused.
#include "sim/sweep/space.h"

#include <gtest/gtest.h>

#include <set>

#include "model/base/error.h"
#include "sim/sweep/expand.h"
#include "tests/sim/program.h"

namespace {

using namespace ctu::sweep;
using ctu::test::ScratchFolder;

class SpaceTest : public ::testing::Test {
 protected:
  Space read(const std::string& text) const {
    ctu::test::write_text(folder_.path() / "space.toml", text);
    return read_space((folder_.path() / "space.toml").string());
  }
  void expect_refused(const std::string& text, int line, const std::string& named) const {
    try {
      read(text);
      ADD_FAILURE() << "taken: " << text;
    } catch (const ctu::Error& error) {
      const std::string said = error.what();
      EXPECT_NE(said.find("space.toml:" + std::to_string(line) + ":"), std::string::npos) << said;
      EXPECT_NE(said.find(named), std::string::npos) << said;
    }
  }
  static std::vector<std::string> values(const Axis& axis) {
    std::vector<std::string> all;
    for (const auto& choice : axis.choices) all.push_back(choice[0]);
    return all;
  }

  ScratchFolder folder_;
};

TEST_F(SpaceTest, lists_ranges_and_doublings_become_axes_in_the_order_of_the_file) {
  const Space space = read(R"(traces = ["a.ctut"]
[axes]
unit.contexts = { range = [8, 30, 8] }
node_cache.bytes = { log2 = [8192, 65536] }
mask_test.design = ["projection", "none"]
box_test.latency = 12
)");
  ASSERT_EQ(space.axes.size(), 4u);
  EXPECT_EQ(values(space.axes[0]), (std::vector<std::string>{"8", "16", "24"}));
  EXPECT_EQ(values(space.axes[1]), (std::vector<std::string>{"8192", "16384", "32768", "65536"}));
  EXPECT_EQ(values(space.axes[2]), (std::vector<std::string>{"projection", "none"}));
  EXPECT_EQ(values(space.axes[3]), (std::vector<std::string>{"12"}));
  EXPECT_EQ(CandidateSpace(space).count(), 3u * 4 * 2);
  // The last axis moves fastest.
  EXPECT_EQ(CandidateSpace(space).at(1), (Candidate{0, 0, 0, 1, 0}));
}

TEST_F(SpaceTest, zipped_keys_move_together) {
  const Space space = read(R"(traces = ["a.ctut"]
[[zip]]
cell_locate.units = [1, 4]
comparators.units = [2, 3]
)");
  const Expander expander(space);
  EXPECT_EQ(expander.settings({0, 1}), (Settings{{"cell_locate.units", "4"}, {"comparators.units", "3"}}));
  const auto config = expander.config({0, 1});
  ASSERT_TRUE(config.has_value());
  EXPECT_EQ(config->cell_locate.units, 4);
  EXPECT_EQ(config->comparators.units, 3);
}

TEST_F(SpaceTest, the_base_holds_for_every_point_and_axes_go_over_it) {
  ctu::test::write_text(folder_.path() / "base.toml", "[unit]\ncontexts = 64\n[stack]\nentries = 8\n");
  const Space space = read(R"(traces = ["a.ctut"]
config = "base.toml"
[set]
box_test.latency = 9
[axes]
stack.entries = [8, 32]
)");
  const auto config = Expander(space).config({0, 1});
  ASSERT_TRUE(config.has_value());
  EXPECT_EQ(config->unit.contexts, 64);
  EXPECT_EQ(config->box_test.latency, 9);
  EXPECT_EQ(config->stack.entries, 32);
}

TEST_F(SpaceTest, what_is_excluded_and_what_no_unit_can_have_is_left_out_and_counted) {
  const Space space = read(R"(traces = ["a.ctut"]
[axes]
mask_test.design = ["none", "projection"]
cell_locate.units = [1, 2, 4]
node_cache.bytes = [65536, 65000]
[[exclude]]
mask_test.design = "none"
cell_locate.units = { above = 1 }
)");
  const GridCount grid = walk_grid(space);
  EXPECT_EQ(grid.candidates, 12u);
  EXPECT_EQ(grid.excluded, 4u);
  EXPECT_EQ(grid.refused, 4u) << "65000 bytes are no power of two of sets";
  EXPECT_NE(grid.first_refusal.find("65000"), std::string::npos);
  EXPECT_EQ(grid.accepted.size(), 4u);
}

TEST_F(SpaceTest, lists_of_recordings_make_groups_whose_scenes_are_judged_together) {
  const Space space = read(R"([[record]]
scene = ["gen:tetra", "gen:foliage"]
r = [4, 6]
size = "8x8"
strip-full = true
[axes]
mask_test.design = ["none", "projection"]
[[exclude]]
record.r = 6
scene = "gen:foliage"
)");
  ASSERT_EQ(space.groups.size(), 2u);
  ASSERT_EQ(space.traces.size(), 4u);
  EXPECT_EQ(space.groups[0].settings, (Settings{{"record.r", "4"}}));
  EXPECT_EQ(space.groups[1].traces.size(), 2u);
  EXPECT_EQ(space.traces[0].record_words,
            (std::vector<std::string>{"record", "gen:tetra", "--r", "4", "--size", "8x8", "--strip-full"}));
  EXPECT_EQ(Expander(space).traces({0, 0}).size(), 2u);
  EXPECT_EQ(Expander(space).traces({1, 0}).size(), 1u);
}

TEST_F(SpaceTest, mistakes_are_told_by_file_and_line) {
  const std::string head = "traces = [\"a.ctut\"]\n";
  expect_refused(head + "[axes]\nnode_cache.byte = [1]\n", 3, "node_cache.bytes");
  expect_refused(head + "[axes]\nunit.contexts = [8, 1000]\n", 3, "1000");
  expect_refused(head + "[axes]\nunit.contexts = []\n", 3, "empty");
  expect_refused(head + "[axes]\nunit.contexts = { range = [8, 4, 1] }\n", 3, "do not lead");
  expect_refused(head + "[axes]\nunit.contexts = { log2 = [0, 4] }\n", 3, "doubling");
  expect_refused(head + "[axes]\nunit.contexts = [1.5]\n", 3, "no value");
  expect_refused(head + "[axes]\nunit.contexts = [1]\n[[zip]]\nunit.contexts = [1]\n", 4, "two axes");
  expect_refused(head + "[[zip]]\nunit.contexts = [1, 2]\nstack.entries = [8]\n", 4, "equally many");
  expect_refused(head + "[[exclude]]\nunit.context = 1\n", 3, "unit.contexts");
  expect_refused(head + "[search]\nmode = \"random\"\n", 2, "number of points");
  expect_refused(head + "[search]\nmode = \"pareto\"\nobjectives = [\"cycles\"]\n", 2, "two objectives");
  expect_refused(head + "axis = 1\n", 2, "axes");
  expect_refused("traces = [\"a.ctut\", \"a.ctut\"]\n", 1, "two traces");
  expect_refused("[[record]]\nsize = \"8x8\"\n", 1, "no scene");
  expect_refused(head + "[axes\n", 2, "mend the TOML");
}

TEST_F(SpaceTest, random_candidates_are_different_accepted_and_the_same_for_a_seed) {
  const CandidateSpace space({2, 7, 5, 3});
  const Accept accept = [](const Candidate& c) { return c[1] != 3; };
  const auto drawn = draw_candidates(space, 60, 9, 0, accept);
  EXPECT_EQ(drawn.size(), 60u);
  EXPECT_EQ(std::set<Candidate>(drawn.begin(), drawn.end()).size(), 60u);
  for (const Candidate& candidate : drawn) {
    EXPECT_TRUE(accept(candidate));
    for (std::size_t i = 0; i < candidate.size(); ++i) EXPECT_LT(candidate[i], space.sizes()[i]);
  }
  EXPECT_EQ(draw_candidates(space, 60, 9, 0, accept), drawn);
  EXPECT_NE(draw_candidates(space, 60, 10, 0, accept), drawn);
  EXPECT_NE(draw_candidates(space, 60, 9, 1, accept), drawn);
  EXPECT_EQ(draw_candidates(space, 1000, 9, 0, accept).size(), 2u * 6 * 5 * 3) << "all that there are";
}

}  // namespace
