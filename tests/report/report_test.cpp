// What `ctusim report` reads, compares and writes, without a browser.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "sim/report/chart.h"
#include "sim/report/page.h"
#include "sim/report/results.h"
#include "tests/sim/program.h"

namespace ctu::test {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

/// Two designs with two sizes of the node cache, as files of `ctusim run --json`.
class ReportOfRuns : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    ASSERT_EQ(run_program(path(), "record 'gen:hair-ball?strands=150' -o hair.ctut --size 16x12").exit_code, 0);
    for (const std::string design : {"none", "projection"})
      for (const std::string bytes : {"2048", "65536"}) {
        const std::string run = "run hair.ctut --set mask_test.design=" + design + " --set node_cache.bytes=" + bytes;
        ASSERT_EQ(run_program(path(), run + " --json " + design + bytes + ".json").exit_code, 0);
      }
  }
  static void TearDownTestSuite() { delete folder_; }
  static const fs::path& path() { return folder_->path(); }

  /// A folder with the same results.
  struct Copy {
    ScratchFolder folder;
    Copy() {
      for (const auto& entry : fs::directory_iterator(ReportOfRuns::path()))
        if (entry.path().extension() == ".json") fs::copy(entry.path(), folder.path());
    }
  };

 private:
  static inline ScratchFolder* folder_ = nullptr;
};

TEST_F(ReportOfRuns, has_a_row_for_each_and_knows_what_was_moved) {
  const report::Results results = report::read_results(path());
  ASSERT_EQ(results.rows.size(), 4u);
  EXPECT_EQ(results.failed, 0u);
  std::vector<std::string> moved = report::moved_columns(results);
  std::sort(moved.begin(), moved.end());
  EXPECT_EQ(moved, (std::vector<std::string>{"config.mask_test.design", "config.node_cache.bytes"}));
  EXPECT_EQ(report::values_of(results, "config.node_cache.bytes"), (std::vector<ordered_json>{2048, 65536}));
  EXPECT_EQ(report::values_of(results, "design"), (std::vector<ordered_json>{"none", "projection"}));
}

TEST_F(ReportOfRuns, compares_each_with_the_best_and_with_no_culling) {
  const report::Results results = report::read_results(path());
  double best = 1e300, best_without = 1e300, intersections = 0;
  for (const ordered_json& row : results.rows) {
    const double cycles = row["cycles_per_ray"];
    best = std::min(best, cycles);
    if (row["design"] != "none") continue;
    best_without = std::min(best_without, cycles);
    intersections = row["intersections_per_ray"];
  }
  for (const ordered_json& row : results.rows) {
    EXPECT_DOUBLE_EQ(row["cycles_over_best"], row["cycles_per_ray"].get<double>() / best);
    EXPECT_DOUBLE_EQ(row["cycles_over_none"], row["cycles_per_ray"].get<double>() / best_without);
    EXPECT_DOUBLE_EQ(row["intersections_over_none"], row["intersections_per_ray"].get<double>() / intersections);
  }
}

TEST_F(ReportOfRuns, shows_shares_of_stages_that_add_up_to_all_cycles) {
  const report::Results results = report::read_results(path());
  const auto charts = report::make_charts(results);
  const auto stages =
      std::find_if(charts.begin(), charts.end(), [](const report::Chart& chart) { return chart.id == "stages"; });
  ASSERT_NE(stages, charts.end());
  const ordered_json& fields = stages->spec["transform"][1]["fold"];
  for (const ordered_json& row : results.rows) {
    std::map<std::string, double> sum;
    for (const ordered_json& field : fields) {
      std::string column = field;
      std::replace(column.begin(), column.end(), '|', '.');
      if (row.contains(column)) sum[column.substr(0, column.find('.', 6))] += row[column].get<double>();
    }
    EXPECT_GT(sum.size(), 8u);
    for (const auto& [stage, share] : sum) EXPECT_NEAR(share, 1, 1e-9) << stage;
  }
}

TEST_F(ReportOfRuns, is_written_plain_with_a_line_for_each_run) {
  const Copy copy;
  const Outcome outcome = run_program(copy.folder.path(), "report . --plain");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::istringstream csv(read_text(copy.folder.path() / "report.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line.rfind("id,scene,", 0), 0u) << line;
  const auto cells = std::count(line.begin(), line.end(), ',');
  int lines = 0;
  for (; std::getline(csv, line); ++lines) EXPECT_GE(std::count(line.begin(), line.end(), ','), cells);
  EXPECT_EQ(lines, 4);
  EXPECT_NE(read_text(copy.folder.path() / "report.gp").find("report-bits.dat"), std::string::npos);
  EXPECT_EQ(count(read_text(copy.folder.path() / "report-bits.dat"), "\"\n"), 2u) << "a block for each design";
}

TEST_F(ReportOfRuns, says_so_when_the_libraries_are_not_there) {
  const Copy copy;
  const Outcome outcome = run_program(copy.folder.path(), "report . --libraries .");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("npm ci"), std::string::npos);
  EXPECT_TRUE(fs::exists(copy.folder.path() / "report.csv"));
  EXPECT_FALSE(fs::exists(copy.folder.path() / "report.html"));
}

TEST_F(ReportOfRuns, lets_no_data_out_of_its_place_in_the_page) {
  if (!report::has_libraries(CTU_REPORT_FOLDER)) GTEST_SKIP() << "run npm ci in report/";
  const std::string evil = "</script><script>alert(1)</script><!-- {{scripts}} &";
  report::Results results = report::read_results(path());
  const auto page_of = [&](const std::string& title) {
    return report::make_page(results, report::make_charts(results), title, CTU_REPORT_FOLDER);
  };
  const std::string plain = page_of("title");
  for (ordered_json& row : results.rows) row["scene"] = evil;
  const std::string page = page_of(evil);
  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
  EXPECT_EQ(count(page, "<script"), count(plain, "<script"));
  EXPECT_EQ(page.find("<script>alert(1)"), std::string::npos);
  EXPECT_NE(plain.find("default-src 'none'"), std::string::npos);
  for (const char* asks : {"src=\"http", "href=\"http", "@import", "url(http"})
    EXPECT_EQ(plain.substr(0, plain.find("<script>")).find(asks), std::string::npos) << asks;
}

TEST_F(ReportOfRuns, shows_a_ladder_that_lies_beside_them) {
  const Copy copy;
  const auto ladder_of = [&]() -> std::optional<report::Chart> {
    for (const report::Chart& chart : report::make_charts(report::read_results(copy.folder.path())))
      if (chart.id == "ladder") return chart;
    return std::nullopt;
  };
  EXPECT_FALSE(ladder_of());
  write_text(copy.folder.path() / "ladder.json",
             R"({"format": "ctusim-ladder", "version": 1, "scene": "hair", "rays": 900, "configs": [
                 {"config": "default", "errors_against": "rtl", "engines": [
                   {"engine": "rtl", "wall_seconds": 12.5, "error_percent": 0, "cycles": 5000},
                   {"engine": "estimate", "wall_seconds": 0.01, "error_percent": -8.0, "cycles": 4600}]},
                 {"config": "small.toml", "errors_against": "cycle", "engines": [
                   {"engine": "rtl", "note": "no build fits"},
                   {"engine": "sampled", "wall_seconds": 0.1, "error_percent": 1.5, "half_width_percent": 2.0,
                    "cycles": 7105}]}]})");
  const auto ladder = ladder_of();
  ASSERT_TRUE(ladder);
  ASSERT_EQ(ladder->rows.size(), 3u) << "what did not run has no place";
  EXPECT_EQ(ladder->rows[1]["error_percent"], -8.0);
  EXPECT_EQ(ladder->rows[1]["shown_percent"], 8.0);
  EXPECT_EQ(ladder->rows[2]["config"], "small.toml");
  write_text(copy.folder.path() / "ladder.json", "[{");
  EXPECT_EQ(run_program(copy.folder.path(), "report .").exit_code, 2);
}

TEST_F(ReportOfRuns, passes_over_files_that_are_no_results) {
  const Copy copy;
  write_text(copy.folder.path() / "other.json", "{\"format\": \"something else\"}");
  write_text(copy.folder.path() / "torn.json", "{\"format\": \"ctusim-result\", ");
  EXPECT_EQ(report::read_results(copy.folder.path()).rows.size(), 4u);
}

TEST(Report, refuses_a_folder_without_results) {
  const ScratchFolder folder;
  for (const char* name : {".", "nowhere"}) {
    const Outcome outcome = run_program(folder.path(), std::string("report ") + name);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("remedy"), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace ctu::test
