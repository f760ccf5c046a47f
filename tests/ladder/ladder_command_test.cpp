// `ctusim ladder` and the engines of its lower rungs from the outside.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/sim/program.h"

namespace {

using ctu::test::Outcome;
using ctu::test::read_text;
using ctu::test::run_program;
using ctu::test::ScratchFolder;
using ctu::test::write_text;
using nlohmann::json;

const std::string kTrace = std::string(CTU_TEST_DATA) + "/hair-ball.ctut";

class LadderCommandTest : public ::testing::Test {
 protected:
  /// With a folder of its own for what is kept between runs.
  Outcome ctusim(const std::string& arguments) const {
    return run_program(folder_.path(), arguments, "export XDG_CACHE_HOME=cache");
  }
  void expect_refused(const std::string& arguments, const std::string& named) const {
    const Outcome outcome = ctusim(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find(named), std::string::npos) << arguments << "\n" << outcome.err;
  }
  json result(const std::string& name) const { return json::parse(read_text(folder_.path() / name)); }

  ScratchFolder folder_;
};

const json& rung(const json& config, const std::string& engine) {
  for (const json& one : config["engines"])
    if (one["engine"] == engine) return one;
  throw std::runtime_error("no engine " + engine);
}

TEST_F(LadderCommandTest, all_engines_stand_in_one_table_and_units_are_compared) {
  write_text(folder_.path() / "few.toml", "[unit]\ncontexts = 8\n");
  write_text(folder_.path() / "many.toml", "[unit]\ncontexts = 32\n");
  const Outcome outcome =
      ctusim("ladder " + kTrace + " few.toml many.toml --errors 10% --repetitions 3 --json ladder.json --out plot");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* part : {"estimate again", "sampled 10%", "cycle", "rtl", "paired"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  const json ladder = result("ladder.json");
  ASSERT_EQ(ladder["configs"].size(), 2u);
  for (const json& config : ladder["configs"]) {
    EXPECT_EQ(config["errors_against"], "cycle");
    EXPECT_EQ(rung(config, "cycle")["error_percent"], 0.0);
    EXPECT_LT(std::abs(rung(config, "estimate")["error_percent"].get<double>()), 15);
    EXPECT_TRUE(rung(config, "rtl").contains("note"));
    ASSERT_EQ(config["coverage"].size(), 1u);
    EXPECT_EQ(config["coverage"][0]["repetitions"], 3);
    EXPECT_LT(std::abs(config["coverage"][0]["bias_percent"].get<double>()), 10);
  }
  const json& relative = ladder["configs"][1]["relative_to_first_config"];
  const double truth = rung(ladder["configs"][1], "cycle")["cycles"].get<double>() /
                       rung(ladder["configs"][0], "cycle")["cycles"].get<double>();
  for (const json& one : relative) {
    EXPECT_NEAR(one["ratio"].get<double>() / truth, 1, one["engine"] == "cycle" ? 1e-12 : 0.15) << one;
  }
  EXPECT_NE(read_text(folder_.path() / "plot" / "ladder.csv").find("few,cycle,"), std::string::npos);
  EXPECT_EQ(result("plot/ladder.json"), ladder);
}

TEST_F(LadderCommandTest, estimate_and_sampled_are_engines_of_run) {
  for (const std::string engine : {"estimate", "sampled --error 8% --seed 3"}) {
    const Outcome outcome = ctusim("run " + kTrace + " --json run.json --engine " + engine);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json run = result("run.json");
    EXPECT_EQ(run["rays"], 2578) << engine;
    EXPECT_GT(run["cycles"].get<long>(), 20000) << engine;
    EXPECT_TRUE(run["wrong_hits"].is_null()) << "nothing was checked: " << engine;
    EXPECT_TRUE(run.contains("approximation")) << engine;
    EXPECT_GE(run["stages"].size(), 10u) << engine;
  }
  const json sampled = result("run.json")["approximation"];
  EXPECT_LE(sampled["cycles_low"], sampled["cycles_high"]);
  EXPECT_EQ(sampled["confidence_percent"], 95.0);
}

TEST_F(LadderCommandTest, what_cannot_be_is_refused) {
  expect_refused("ladder " + kTrace + " --errors two", "--errors");
  expect_refused("ladder " + kTrace + " --errors 0%", "--error");
  expect_refused("ladder " + kTrace + " --confidence 100%", "--confidence");
  expect_refused("ladder " + kTrace + " nowhere.toml", "nowhere.toml");
  expect_refused("run " + kTrace + " --engine sampled --error 2x", "--error");
  expect_refused("run " + kTrace + " --error 2%", "--engine sampled");
}

}  // namespace
