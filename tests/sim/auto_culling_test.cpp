// `record --culling auto` and `decide` from the outside.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/sim/program.h"

namespace {

using ctu::test::Outcome;
using ctu::test::read_text;
using ctu::test::run_program;
using ctu::test::ScratchFolder;
using nlohmann::json;

double cycles_per_ray(const ScratchFolder& folder, const std::string& trace, const std::string& design) {
  const Outcome outcome =
      run_program(folder.path(), "run " + trace + " --json r.json --set mask_test.design=" + design);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(read_text(folder.path() / "r.json"))["cycles_per_ray"];
}

void record(const ScratchFolder& folder, const std::string& scene, const std::string& culling) {
  const Outcome outcome =
      run_program(folder.path(), "record '" + scene + "' -o " + culling + ".ctut --size 60x34 --culling " + culling);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST(AutoCulling, is_at_most_a_percent_slower_than_the_better_of_on_and_off) {
  for (const std::string scene : {"gen:tetra", "gen:straight-hair?strands=500", "gen:hair-ball?strands=500"}) {
    const ScratchFolder folder;
    for (const char* culling : {"on", "off", "auto"}) record(folder, scene, culling);
    const double on = cycles_per_ray(folder, "on.ctut", "projection");
    const double off = cycles_per_ray(folder, "off.ctut", "none");
    const Outcome info = run_program(folder.path(), "trace info auto.ctut");
    const bool chose_off = info.out.find("culling: off for projection") != std::string::npos;
    EXPECT_NE(info.out.find("forecast from"), std::string::npos) << info.out;
    const double chosen = cycles_per_ray(folder, "auto.ctut", chose_off ? "none" : "projection");
    EXPECT_LE(chosen, 1.01 * std::min(on, off)) << scene << ": on " << on << ", off " << off;
  }
}

TEST(AutoCulling, decide_checks_its_forecast_against_all_rays) {
  const ScratchFolder folder;
  const Outcome outcome = run_program(
      folder.path(), "decide gen:tetra 'gen:straight-hair?strands=500' --size 60x34 --pilot 1000 --markdown");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("| gen:tetra | "), std::string::npos) << outcome.out;
}

TEST(AutoCulling, bad_arguments_are_refused_by_name) {
  const ScratchFolder folder;
  const std::string base = "record gen:tetra -o t.ctut --size 8x8 ";
  for (const auto& [arguments, named] :
       {std::pair{base + "--culling yes", "--culling"}, std::pair{base + "--set unit.contexts=4", "--culling auto"},
        std::pair{base + "--culling auto --set unit.contxts=4", "unit.contexts"},
        std::pair{base + "--culling auto -c missing.toml", "missing.toml"},
        std::pair{base + "--culling auto --set mask_test.design=bit-table", "bit-table"},
        std::pair{std::string("decide gen:tetra --set mask_test.design=ideal"), "mask_test.design"},
        std::pair{std::string("decide gen:nothing"), "gen:nothing"}}) {
    const Outcome outcome = run_program(folder.path(), arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.out;
    EXPECT_NE((outcome.err + outcome.out).find(named), std::string::npos) << arguments << "\n" << outcome.err;
  }
}

}  // namespace
