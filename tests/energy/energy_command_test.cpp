// `ctusim run` says what a run cost, of its own counters, with our table or the user's.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/sim/program.h"

namespace {

using ctu::test::Outcome;
using ctu::test::read_text;
using ctu::test::run_program;
using ctu::test::ScratchFolder;
using ctu::test::write_text;
using nlohmann::json;

class EnergyCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome outcome = run_program(folder_.path(),
                                        "record 'gen:hair-ball?strands=200&seed=3' -o hair.ctut --size "
                                        "24x24 --rays diffuse --bounces 1");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  json run(const std::string& arguments) {
    const Outcome outcome = run_program(folder_.path(), "run hair.ctut --json result.json " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return json::parse(read_text(folder_.path() / "result.json"));
  }
  ScratchFolder folder_;
};

double counter(const json& result, const std::string& name) {
  for (const json& entry : result["counters"])
    if (entry["name"] == name) return entry["value"].get<double>();
  ADD_FAILURE() << "no counter " << name;
  return 0;
}

double count_of(const json& result, const std::string& stage, const std::string& name) {
  for (const json& item : result["energy"]["items"])
    if (item["stage"] == stage && item["item"] == name) return item["count"].get<double>();
  ADD_FAILURE() << "no item " << stage << ": " << name;
  return 0;
}

TEST_F(EnergyCommand, energy_is_made_of_the_runs_own_counters_and_adds_up) {
  const json result = run("");
  EXPECT_EQ(count_of(result, "box_test", "slabs of four boxes"), counter(result, "traversal.node_visits"));
  EXPECT_EQ(count_of(result, "triangle_test", "triangles"), counter(result, "traversal.triangle_tests"));
  EXPECT_EQ(count_of(result, "memory", "lines of nodes"), counter(result, "memory.node_requests"));
  EXPECT_EQ(count_of(result, "mask_test", "projections xy read"), counter(result, "mask_test.projections_xy.reads"));
  EXPECT_EQ(count_of(result, "cell_locate", "cells located"), counter(result, "cell_locate.lanes"));
  double stages = 0, items = 0, bits = 0;
  for (const json& stage : result["energy"]["stages"]) stages += stage["pj"].get<double>();
  for (const json& item : result["energy"]["items"]) items += item["pj"].get<double>();
  for (const json& structure : result["on_chip"]) bits += structure["bits"].get<double>();
  EXPECT_NEAR(stages, items, 1e-6 * items);
  EXPECT_NEAR(result["energy_per_ray_pj"].get<double>() * result["rays"].get<double>(),
              items + result["energy"]["static_pj"].get<double>(), 1e-6 * items);
  EXPECT_EQ(result["on_chip_bits"].get<double>(), bits);
}

TEST_F(EnergyCommand, another_table_changes_energy_and_nothing_else) {
  std::string text = read_text(CTU_ENERGY_TABLE);
  text.replace(text.find("value = 3.92"), 12, "value = 7.84");
  write_text(folder_.path() / "mine.toml", text);
  const json ours = run(""), theirs = run("--energy mine.toml");
  EXPECT_EQ(ours["cycles"], theirs["cycles"]);
  EXPECT_EQ(ours["config_hash"], theirs["config_hash"]);
  EXPECT_NE(ours["energy"]["table_hash"], theirs["energy"]["table_hash"]);
  const auto memory = [](const json& result) {
    for (const json& stage : result["energy"]["stages"])
      if (stage["stage"] == "memory") return stage["pj"].get<double>();
    return 0.0;
  };
  EXPECT_GT(memory(ours), 0);
  EXPECT_NEAR(memory(theirs), 2 * memory(ours), 1e-6 * memory(ours));
}

TEST_F(EnergyCommand, an_untimed_run_says_bits_and_no_energy) {
  const json result = run("--engine reference");
  EXPECT_FALSE(result.contains("energy_per_ray_pj"));
  EXPECT_GT(result["on_chip_bits"].get<double>(), 1e6);
}

TEST_F(EnergyCommand, a_bad_table_is_a_mistake_of_the_user) {
  write_text(folder_.path() / "bad.toml", "name = \"x\"\n");
  const Outcome bad = run_program(folder_.path(), "run hair.ctut --energy bad.toml");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find("bad.toml"), std::string::npos) << bad.err;
  EXPECT_EQ(run_program(folder_.path(), "run hair.ctut --energy none.toml").exit_code, 2);
}

}  // namespace
