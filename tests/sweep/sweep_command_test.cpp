// `ctusim sweep` from the outside: a space becomes tables, what is there is not run again, what fails is told, and no
// runner and no order shows in a row.
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/sim/program.h"

namespace {

using ctu::test::Outcome;
using ctu::test::read_text;
using ctu::test::run_program;
using ctu::test::ScratchFolder;
using ctu::test::write_text;
using nlohmann::json;

constexpr const char* kSpace = R"([[record]]
scene = ["gen:tetra", "gen:hair-ball?strands=60&seed=7"]
rays = "diffuse"
size = "12x8"

[axes]
mask_test.design = ["none", "projection"]
node_cache.bytes = { log2 = [1024, 4096] }
)";

std::vector<json> rows_of(const std::filesystem::path& file) {
  std::istringstream in(read_text(file));
  std::vector<json> rows;
  for (std::string line; std::getline(in, line);) rows.push_back(json::parse(line));
  return rows;
}

class SweepCommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    write_text(folder_->path() / "space.toml", kSpace);
    const Outcome outcome = ctusim("sweep run space.toml -o once -j 2");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static Outcome ctusim(const std::string& arguments) { return run_program(folder_->path(), arguments); }
  static std::filesystem::path file(const std::string& name) { return folder_->path() / name; }
  static ScratchFolder* folder_;
};
ScratchFolder* SweepCommandTest::folder_ = nullptr;

TEST_F(SweepCommandTest, every_point_has_a_row_that_its_command_makes_again) {
  const auto rows = rows_of(file("once/results.jsonl"));
  ASSERT_EQ(rows.size(), 2u * 2 * 3);
  std::set<std::string> ids;
  for (const json& row : rows) {
    EXPECT_EQ(row["status"], "done");
    EXPECT_EQ(row["wrong_hits"], 0);
    EXPECT_GT(row["cycles_per_ray"], 0);
    EXPECT_TRUE(ids.insert(row["id"]).second) << "twice: " << row["id"];
  }
  const json& last = rows.back();
  EXPECT_EQ(last["scene"], "gen:hair-ball?strands=60&seed=7");
  EXPECT_EQ(last["config.mask_test.design"], "projection");
  EXPECT_EQ(last["config.node_cache.bytes"], 4096);
  const std::string words = last["command"].get<std::string>().substr(std::string("ctusim ").size());
  const Outcome again = run_program(file("once"), words + " --json ../again.json");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const json run = json::parse(read_text(file("again.json")));
  for (const char* key : {"cycles", "rays", "config_hash", "trace_hash", "culled_share", "event_log_hash"})
    EXPECT_EQ(run[key], last[key]) << key;
  double busy = last["stage.box_test.busy"], stalled = last["stage.box_test.stalled"],
         idle = last["stage.box_test.idle"];
  EXPECT_NEAR(busy + stalled + idle, 1, 1e-9);
}

TEST_F(SweepCommandTest, what_is_there_is_not_run_again_and_a_grown_space_adds_to_it) {
  const std::string before = read_text(file("once/results.jsonl")), part = read_text(file("once/parts/local.jsonl"));
  const Outcome again = ctusim("sweep space.toml -o once");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find("12 of 12 points are there already"), std::string::npos) << again.out;
  EXPECT_EQ(read_text(file("once/parts/local.jsonl")), part);
  EXPECT_EQ(read_text(file("once/results.jsonl")), before);

  std::string grown = kSpace;
  grown.replace(grown.find("4096"), 4, "8192");
  write_text(file("grown.toml"), grown);
  EXPECT_EQ(ctusim("sweep run grown.toml -o once -j 2").exit_code, 0);
  EXPECT_EQ(rows_of(file("once/results.jsonl")).size(), 16u);
  EXPECT_EQ(read_text(file("once/parts/local.jsonl")).substr(0, part.size()), part) << "what was there stays";
  EXPECT_EQ(ctusim("sweep run space.toml -o once").exit_code, 0);
  EXPECT_EQ(read_text(file("once/results.jsonl")), before) << "points of another space are no part of this one";
}

TEST_F(SweepCommandTest, neither_order_nor_number_of_processes_shows_in_any_table) {
  ASSERT_EQ(ctusim("sweep run space.toml -o one -j 1").exit_code, 0);
  ASSERT_EQ(ctusim("sweep run space.toml -o five -j 5").exit_code, 0);
  for (const char* name : {"results.jsonl", "results.csv", "results.sqlite", "columns.csv"})
    EXPECT_EQ(read_text(file("one") / name), read_text(file("five") / name)) << name;
  EXPECT_EQ(rows_of(file("one/parts/local.timings.jsonl")).size(), 12u);
}

TEST_F(SweepCommandTest, every_column_has_a_meaning_and_the_page_lists_the_fixed_ones) {
  std::istringstream notes(read_text(file("once/columns.csv")));
  std::string line;
  std::getline(notes, line);
  EXPECT_EQ(line, "column,unit,meaning");
  std::size_t columns = 0;
  for (; std::getline(notes, line); ++columns) EXPECT_NE(line.back(), ',') << line;
  EXPECT_GT(columns, 100u);
  const std::string page = read_text(CTU_SWEEPS_PAGE);
  const json row = rows_of(file("once/results.jsonl")).front();
  for (const auto& [column, value] : row.items())
    EXPECT_TRUE(column.find('.') != std::string::npos || page.find("| `" + column + "` |") != std::string::npos)
        << column;
}

TEST_F(SweepCommandTest, a_point_that_fails_is_told_with_its_command_and_the_rest_goes_on) {
  write_text(file("failing.toml"), R"([[record]]
scene = "gen:hair-ball?strands=60&seed=7"
rays = "diffuse"
size = "12x8"
culling = "off"
[axes]
mask_test.design = ["none", "projection"]
)");
  const Outcome outcome = ctusim("sweep run failing.toml -o failing");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("2 points: 1 done, 1 refused"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("carries no masks"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("ctusim run traces/"), std::string::npos) << outcome.out;
  const auto rows = rows_of(file("failing/results.jsonl"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["status"], "done");
  EXPECT_EQ(rows[1]["status"], "refused");
  EXPECT_EQ(rows[1]["message"].get<std::string>().find(file("failing").string()), std::string::npos)
      << "no path of this machine in a row: " << rows[1]["message"];
  EXPECT_EQ(ctusim("sweep status failing").exit_code, 1);

  const std::string part = read_text(file("failing/parts/local.jsonl"));
  EXPECT_EQ(ctusim("sweep run failing.toml -o failing").exit_code, 1);
  EXPECT_EQ(read_text(file("failing/parts/local.jsonl")), part) << "a failure is recorded: it is not tried again";
  EXPECT_EQ(ctusim("sweep run failing.toml -o failing --retry-failed").exit_code, 1);
  EXPECT_GT(read_text(file("failing/parts/local.jsonl")).size(), part.size());
  EXPECT_EQ(rows_of(file("failing/results.jsonl")).size(), 2u);
}

TEST_F(SweepCommandTest, a_point_without_memory_is_recorded_and_the_sweep_goes_on) {
  const Outcome outcome = ctusim("sweep run space.toml -o small --memory 100K");
  EXPECT_EQ(outcome.exit_code, 1);
  const auto rows = rows_of(file("small/results.jsonl"));
  ASSERT_EQ(rows.size(), 12u);
  EXPECT_EQ(rows[0]["status"], "out-of-memory") << rows[0]["message"];
  EXPECT_EQ(ctusim("sweep run space.toml -o small --memory 1G --retry-failed").exit_code, 0);
}

TEST_F(SweepCommandTest, a_time_limit_ends_long_points_and_records_them) {
  const Outcome outcome = ctusim("sweep run space.toml -o late --time-limit 0.000001");
  EXPECT_EQ(outcome.exit_code, 1);
  for (const json& row : rows_of(file("late/results.jsonl")))
    EXPECT_TRUE(row["status"] == "timeout" || row["status"] == "done") << row["message"];
  EXPECT_EQ(ctusim("sweep run space.toml -o late --retry-failed").exit_code, 0);
  EXPECT_EQ(read_text(file("late/results.jsonl")), read_text(file("once/results.jsonl")));
}

TEST_F(SweepCommandTest, the_reference_runs_the_same_space_without_cycles) {
  ASSERT_EQ(ctusim("sweep run space.toml -o reference --engine reference").exit_code, 0);
  const auto timed = rows_of(file("once/results.jsonl")), untimed = rows_of(file("reference/results.jsonl"));
  ASSERT_EQ(untimed.size(), timed.size());
  for (std::size_t i = 0; i < timed.size(); ++i) {
    EXPECT_EQ(untimed[i].count("cycles"), 0u);
    EXPECT_EQ(untimed[i]["intersections_per_ray"], timed[i]["intersections_per_ray"]);
    EXPECT_NE(untimed[i]["id"], timed[i]["id"]);
  }
}

TEST_F(SweepCommandTest, a_search_asks_what_its_answers_suggest_and_repeats_itself_without_running_anything) {
  const std::string text = R"([[record]]
scene = "gen:hair-ball?strands=60&seed=7"
rays = "diffuse"
size = "12x8"
[axes]
unit.contexts = { log2 = [1, 64] }
node_cache.bytes = { log2 = [1024, 65536] }
leaf_cache.bytes = { log2 = [1024, 65536] }
[search]
mode = "pareto"
objectives = ["cycles_per_ray", "contexts.most_occupied"]
population = 6
generations = 3
)";
  write_text(file("search.toml"), text);
  const Outcome first = ctusim("sweep run search.toml -o search -j 2");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const json search = json::parse(read_text(file("search/search.json")));
  EXPECT_EQ(search["guided"]["configurations"], 18);
  EXPECT_EQ(search["random"]["configurations"], 18);
  for (const char* name : {"guided", "random"}) {
    const json& front = search[name]["front"];
    ASSERT_GT(front.size(), 0u);
    for (std::size_t i = 1; i < front.size(); ++i) {
      EXPECT_GT(front[i]["cycles_per_ray"], front[i - 1]["cycles_per_ray"]);
      EXPECT_LT(front[i]["contexts.most_occupied"], front[i - 1]["contexts.most_occupied"]);
    }
    EXPECT_GT(search[name]["hypervolume"], 0);
    EXPECT_LE(search[name]["hypervolume"], 1);
  }
  const std::string part = read_text(file("search/parts/local.jsonl")), table = read_text(file("search/results.jsonl"));
  EXPECT_EQ(ctusim("sweep run search.toml -o search").exit_code, 0);
  EXPECT_EQ(read_text(file("search/parts/local.jsonl")), part);
  EXPECT_EQ(read_text(file("search/results.jsonl")), table);
  EXPECT_EQ(json::parse(read_text(file("search/search.json"))), search);

  // Cut off in the midst, as by a kill: the search asks again from its beginning and runs only what is lost.
  write_text(file("search/parts/local.jsonl"), part.substr(0, part.size() / 2));
  EXPECT_EQ(ctusim("sweep run search.toml -o search").exit_code, 0);
  EXPECT_EQ(read_text(file("search/results.jsonl")), table);

  std::string misspelt = text;
  misspelt.replace(misspelt.find("cycles_per_ray"), 14, "cycles_per_day");
  write_text(file("misspelt.toml"), misspelt);
  const Outcome refused = ctusim("sweep run misspelt.toml -o misspelt");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("cycles_per_day"), std::string::npos) << refused.err;
}

TEST_F(SweepCommandTest, mistakes_end_in_one_message) {
  const auto expect_refused = [](const std::string& arguments, const std::string& named) {
    const Outcome outcome = ctusim(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find(named), std::string::npos) << arguments << "\n" << outcome.err;
  };
  expect_refused("sweep", "no file is named");
  expect_refused("sweep space.toml", "no folder");
  expect_refused("sweep run nothing.toml -o x", "nothing.toml");
  expect_refused("sweep run space.toml -o x --memory 2X", "2X");
  expect_refused("sweep run space.toml -o x --on moon", "moon");
  expect_refused("sweep run space.toml -o x --chunk 3", "--on slurm");
  expect_refused("sweep run space.toml -o x --engine magic", "magic");
  expect_refused("sweep status space.toml", "no folder of a sweep");
  expect_refused("sweep collect nowhere", "no folder of a sweep");
  write_text(file("other.toml"), "traces = [\"gone.ctut\"]\n");
  expect_refused("sweep run other.toml -o x", "gone.ctut");
  write_text(file("record.toml"), "[[record]]\nscene = \"gen:tetra\"\nsizes = \"8x8\"\n");
  expect_refused("sweep run record.toml -o x", "--sizes");
}

}  // namespace
