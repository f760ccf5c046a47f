// Results on the disk: whole lines count, torn ones are cut off, nobody writes beside another.
#include "sim/sweep/result_store.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "sim/sweep/collect.h"
#include "sim/sweep/row.h"
#include "tests/sim/program.h"

namespace {

using namespace ctu::sweep;
using ctu::test::read_text;
using ctu::test::ScratchFolder;
using ctu::test::write_text;

class ResultStoreTest : public ::testing::Test {
 protected:
  ScratchFolder scratch_;
  SweepFolder folder_{scratch_.path() / "sweep", true};
  std::filesystem::path part(const std::string& name) const { return folder_.parts() / name; }

  static std::string line(const std::string& id, const std::string& status, int cycles = 0) {
    return R"({"id":")" + id + R"(","status":")" + status + R"(","message":"","cycles":)" + std::to_string(cycles) +
           "}";
  }
  static Point point(const std::string& id, const std::string& scene) {
    Point point;
    point.id = id;
    point.engine = "cycle";
    point.design = "none";
    point.trace.name = scene + ".ctut";
    point.trace.scene = scene;
    point.settings = {{"unit.contexts", "8"}, {"scheduler.policy", "oldest"}};
    return point;
  }
};

TEST_F(ResultStoreTest, a_line_that_was_not_written_to_its_end_is_cut_off_and_its_point_is_missing) {
  const std::string whole = line("a", "done", 5) + "\n" + line("b", "done", 6) + "\n";
  for (std::size_t torn = 1; torn < 20; ++torn) {
    write_text(part("local.jsonl"), whole + line("c", "done", 7).substr(0, torn));
    StoredResults results = read_results(folder_);
    EXPECT_EQ(results.torn_parts, 1u);
    EXPECT_FALSE(results.has("c"));
    PartWriter(folder_, "local").append(line("d", "done", 8), "{}");
    EXPECT_EQ(read_text(part("local.jsonl")), whole + line("d", "done", 8) + "\n");
    results = read_results(folder_);
    EXPECT_EQ(results.torn_parts, 0u);
    EXPECT_EQ(results.lines, 3u);
  }
}

TEST_F(ResultStoreTest, a_torn_line_longer_than_any_buffer_and_a_file_of_nothing_else_are_cut) {
  write_text(part("local.jsonl"), std::string(20000, 'x'));
  EXPECT_EQ(cut_torn_line(part("local.jsonl")), 20000u);
  EXPECT_EQ(read_text(part("local.jsonl")), "");
  write_text(part("local.jsonl"), "one\n" + std::string(9000, 'x'));
  EXPECT_EQ(cut_torn_line(part("local.jsonl")), 9000u);
  EXPECT_EQ(read_text(part("local.jsonl")), "one\n");
  EXPECT_EQ(cut_torn_line(part("local.jsonl")), 0u);
  EXPECT_EQ(cut_torn_line(part("none.jsonl")), 0u);
}

TEST_F(ResultStoreTest, a_result_takes_the_place_of_a_failure_and_never_the_other_way) {
  write_text(part("a.jsonl"), line("x", "timeout") + "\n" + line("y", "done", 4) + "\n");
  write_text(part("b.jsonl"), line("x", "done", 3) + "\n" + line("y", "timeout") + "\n");
  const StoredResults results = read_results(folder_);
  EXPECT_EQ(results.status_of.at("x"), "done");
  EXPECT_EQ(results.status_of.at("y"), "done");
  EXPECT_EQ(results.lines, 4u);
  EXPECT_EQ(results.repeated, 2u);
}

TEST_F(ResultStoreTest, two_results_of_a_point_that_differ_are_refused) {
  write_text(part("a.jsonl"), line("x", "done", 3) + "\n");
  write_text(part("b.jsonl"), line("x", "done", 3) + "\n");
  EXPECT_EQ(read_results(folder_).line_of.size(), 1u);
  write_text(part("b.jsonl"), line("x", "done", 4) + "\n");
  EXPECT_THROW(read_results(folder_), ctu::Error);
}

TEST_F(ResultStoreTest, a_second_writer_is_refused_while_the_first_lives) {
  {
    const PartWriter first(folder_, "local");
    EXPECT_THROW(PartWriter(folder_, "local"), ctu::Error);
    EXPECT_NO_THROW(PartWriter(folder_, "other"));
  }
  EXPECT_NO_THROW(PartWriter(folder_, "local"));
}

TEST_F(ResultStoreTest, tables_have_the_rows_of_points_in_their_order_with_every_column_of_any) {
  write_text(part("a.jsonl"), R"({"id":"2","status":"done","message":"","cycles":7,"extra":0.5})"
                              "\n" +
                                  line("1", "done", 5) + "\n" + line("9", "done", 1) + "\n" +
                                  R"({"id":"3","status":"refused","message":"a \"b\", c"})" + "\n");
  const Table table =
      make_table({point("1", "p"), point("2", "q"), point("3", "r"), point("4", "s")}, read_results(folder_), {});
  ASSERT_EQ(table.rows.size(), 3u) << "point 4 was not run, 9 is no point";
  EXPECT_EQ(table.rows[1].at("extra"), 0.5);
  EXPECT_EQ(table.rows[0].at("config.unit.contexts"), 8);
  EXPECT_EQ(table.rows[0].at("config.scheduler.policy"), "oldest");
  EXPECT_EQ(table.columns.back(), "command");
  const std::string csv = to_csv(table);
  EXPECT_NE(csv.find("cycles,extra,message,command\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",oldest,5,,,ctusim run p.ctut\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",oldest,,,\"a \"\"b\"\", c\",ctusim run r.ctut\n"), std::string::npos) << csv;
}

TEST_F(ResultStoreTest, the_database_holds_what_the_table_holds) {
  write_text(part("a.jsonl"), line("1", "done", 5) + "\n" + line("2", "done", 7) + "\n");
  const Table table = make_table({point("1", "p"), point("2", "q")}, read_results(folder_), {});
  const auto file = scratch_.path() / "results.sqlite";
  write_sqlite(table, file);
  write_sqlite(table, file);  // anew, not in addition
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  std::vector<std::string> found;
  const auto collect = [](void* to, int cells, char** values, char**) {
    std::string row;
    for (int i = 0; i < cells; ++i) row += std::string(values[i] == nullptr ? "-" : values[i]) + " ";
    static_cast<std::vector<std::string>*>(to)->push_back(row);
    return 0;
  };
  ASSERT_EQ(
      sqlite3_exec(database,
                   "SELECT scene, cycles * 2, typeof(cycles), \"config.unit.contexts\" FROM results ORDER BY cycles",
                   collect, &found, nullptr),
      SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, "SELECT unit FROM columns WHERE name = 'cycles'", collect, &found, nullptr),
            SQLITE_OK);
  sqlite3_close(database);
  EXPECT_EQ(found, (std::vector<std::string>{"p 10 integer 8 ", "q 14 integer 8 ", "cycles "}));
}

}  // namespace
