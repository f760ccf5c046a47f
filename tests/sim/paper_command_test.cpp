// `ctusim paper subspace` from the outside, on a generated scene and a picture of a few pixels.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <vector>

#include "tests/sim/program.h"

namespace {

using ctu::test::Outcome;
using ctu::test::read_text;
using ctu::test::run_program;
using ctu::test::ScratchFolder;
using ctu::test::write_text;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

/// The rows of a comma-separated file without its title.
std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : split(text, '\n')) rows.push_back(split(line, ','));
  if (!rows.empty()) rows.erase(rows.begin());
  return rows;
}

class PaperCommandTest : public ::testing::Test {
 protected:
  Outcome paper(const std::string& arguments, const std::string& out = "out") {
    return run_program(folder_.path(),
                       "paper subspace --size 16x12 --spp 1 --bounces 2 --out " + out + " " + arguments);
  }
  std::string written(const std::string& name) { return read_text(folder_.path() / "out" / name); }

  ScratchFolder folder_;
};

TEST_F(PaperCommandTest, prints_every_table_and_writes_the_data_of_the_plots) {
  const Outcome outcome = paper("'gen:hair-ball?strands=100' gen:tetra?depth=3");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* title : {"Table 1: intersections relative to no culling, R = 4", "no culling, R = 6", "Table 2",
                            "Section 4.2", "Table 3", "Fig. 8", "*paper: Hairball (like)*"})
    EXPECT_NE(outcome.out.find(title), std::string::npos) << title;
  EXPECT_EQ(outcome.out, written("subspace.md"));

  const auto ratios = rows_of(written("table1.csv"));
  ASSERT_EQ(ratios.size(), 4u);
  for (const auto& row : ratios) {
    ASSERT_EQ(row.size(), 12u);
    for (std::size_t i = 2; i < 8; ++i) {
      EXPECT_GT(std::stod(row[i]), 5) << row[0];
      EXPECT_LE(std::stod(row[i]), 100) << row[0];
    }
  }
  EXPECT_EQ(ratios[0][8], "67") << "the paper's Hairball, ideal, R = 4";
  EXPECT_EQ(rows_of(written("fig8.csv")).size(), 2u * 2 * 6);
}

TEST_F(PaperCommandTest, without_gnuplot_says_what_to_install_and_keeps_the_data) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.path().c_str(), 1);
  const Outcome outcome = paper("gen:tetra?depth=2");
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("gnuplot-nox"), std::string::npos) << outcome.err;
  EXPECT_FALSE(written("fig8.gp").empty());
  EXPECT_TRUE(written("fig8.svg").empty());
}

TEST_F(PaperCommandTest, an_index_gives_names_to_scenes) {
  write_text(folder_.path() / "one.nff", "p 3\n0 0 0\n1 0 0\n0 1 1\n");
  write_text(folder_.path() / "ball.nff", "s 0 0 0 1\n");
  write_text(folder_.path() / "cut.nff", "p 3\n0 0 0\n1 0\n");
  write_text(folder_.path() / "index.txt", "triangle one.nff\nball ball.nff\nbroken cut.nff\n");
  for (const std::string name : {"triangle", "ball"}) {
    const Outcome named = paper("--index index.txt " + name);
    EXPECT_EQ(named.exit_code, 0) << named.err;
    EXPECT_NE(named.out.find("| " + name + " |"), std::string::npos) << named.out;
  }
  const Outcome refused = paper("--index index.txt broken");
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_NE(refused.err.find("cut.nff"), std::string::npos) << refused.err;
}

TEST_F(PaperCommandTest, mistakes_of_the_user_end_in_one_message_and_exit_code_2) {
  const auto expect_refused = [&](const std::string& arguments, const std::string& named) {
    const Outcome outcome = paper(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << outcome.err;
    EXPECT_NE(outcome.err.find(named), std::string::npos) << arguments << outcome.err;
  };
  expect_refused("", "SCENE");
  expect_refused("nowhere.obj", "nowhere.obj");
  expect_refused("gen:tetra --index absent.txt", "absent.txt");
  write_text(folder_.path() / "bad.txt", "one one.nff\ntwo\n");
  expect_refused("gen:tetra --index bad.txt", "bad.txt:2");
  write_text(folder_.path() / "file", "");
  const Outcome no_folder = paper("gen:tetra", "file/folder");
  EXPECT_EQ(no_folder.exit_code, 2);
  EXPECT_NE(no_folder.err.find("file/folder"), std::string::npos) << no_folder.err;
}

}  // namespace
