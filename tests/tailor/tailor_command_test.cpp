// `ctusim tailor` from the outside: a smaller unit with the same hits, and another scene's refusal by the missing part.
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

constexpr const char* kSmallStart =
    "[unit]\ncontexts = 16\n[node_cache]\nbytes = 8192\nmshrs = 4\n[leaf_cache]\nbytes = 8192\nmshrs = 4\n";

class TailorCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    write_text(folder_->path() / "start.toml", kSmallStart);
    for (const char* scene : {"'gen:hair-ball?strands=100&seed=2' -o hair.ctut", "gen:balls?depth=1 -o balls.ctut"}) {
      const Outcome outcome =
          run_program(folder_->path(), std::string("record ") + scene + " --size 20x20 --rays diffuse --bounces 1");
      ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }
    tailored_ = new Outcome(run_program(
        folder_->path(),
        "tailor hair.ctut -c start.toml --slowdown 2% --restarts 1 --rtl-rays 0 -o hair.toml --json hair.json"));
  }
  static void TearDownTestSuite() {
    delete tailored_;
    delete folder_;
  }
  static Outcome ctusim(const std::string& arguments) { return run_program(folder_->path(), arguments); }

  static ScratchFolder* folder_;
  static Outcome* tailored_;
};
ScratchFolder* TailorCommand::folder_ = nullptr;
Outcome* TailorCommand::tailored_ = nullptr;

TEST_F(TailorCommand, a_smaller_unit_gives_the_same_hits_within_the_slowdown) {
  ASSERT_EQ(tailored_->exit_code, 0) << tailored_->err;
  const json report = json::parse(read_text(folder_->path() / "hair.json"));
  const json &before = report["before"][0], &after = report["after"][0];
  EXPECT_LT(after["on_chip_bits"].get<double>(), before["on_chip_bits"].get<double>());
  EXPECT_LE(after["cycles"].get<double>(), 1.02 * before["cycles"].get<double>());
  EXPECT_EQ(after["wrong_hits"], 0);
  EXPECT_EQ(after["rays"], before["rays"]);
  EXPECT_FALSE(report["changes"].empty());
  for (const json& change : report["changes"]) EXPECT_FALSE(change["reason"].get<std::string>().empty());
  const Outcome run = ctusim("run hair.ctut -c hair.toml --json run.json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json result = json::parse(read_text(folder_->path() / "run.json"));
  EXPECT_EQ(result["cycles"], after["cycles"]);
  EXPECT_EQ(result["on_chip_bits"], after["on_chip_bits"]);
}

TEST_F(TailorCommand, another_scene_is_refused_by_the_part_that_is_missing) {
  const Outcome refused = ctusim("run balls.ctut -c hair.toml");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("sphere_test"), std::string::npos) << refused.err;
  EXPECT_EQ(ctusim("run balls.ctut -c start.toml").exit_code, 0);
}

TEST_F(TailorCommand, a_tailored_file_is_not_taken_where_nothing_checks_its_parts) {
  const Outcome refused = ctusim("compare hair.ctut -c hair.toml");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("[parts]"), std::string::npos) << refused.err;
}

TEST_F(TailorCommand, mistakes_are_the_users) {
  EXPECT_EQ(ctusim("tailor hair.ctut --slowdown much").exit_code, 2);
  EXPECT_EQ(ctusim("tailor none.ctut").exit_code, 2);
  EXPECT_EQ(ctusim("tailor hair.ctut -c none.toml").exit_code, 2);
  write_text(folder_->path() / "odd.toml", "[parts]\nwings = true\n");
  const Outcome odd = ctusim("run hair.ctut -c odd.toml");
  EXPECT_EQ(odd.exit_code, 2);
  EXPECT_NE(odd.err.find("[parts]"), std::string::npos) << odd.err;
}

}  // namespace
