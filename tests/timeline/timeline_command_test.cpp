// `ctusim run --timeline`: files by their name, windows, and what is refused.
#include <gtest/gtest.h>

#include <zstd.h>

#include "tests/sim/program.h"
#include "tests/timeline/kanata_reader.h"
#include "tests/timeline/perfetto_reader.h"

namespace ctu::test {
namespace {

class TimelineCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    const Outcome outcome = run_program(
        folder_->path(), "record 'gen:hair-ball?strands=200&seed=3' -o hair.ctut --size 24x24 --rays diffuse");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string timeline(const std::string& name, const std::string& options = "") {
    const Outcome outcome = run_program(folder_->path(), "run hair.ctut --timeline " + name + " " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return read_text(folder_->path() / name);
  }
  static void expect_refused(const std::string& options, const std::string& word) {
    const Outcome outcome = run_program(folder_->path(), "run hair.ctut " + options);
    EXPECT_EQ(outcome.exit_code, 2) << options;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("remedy"), std::string::npos) << outcome.err;
  }

 private:
  static inline ScratchFolder* folder_ = nullptr;
};

TEST_F(TimelineCommand, writes_what_the_name_says) {
  const std::string log = timeline("a.kanata"), packed = timeline("a.kanata.zst"), trace = timeline("a.pftrace");
  EXPECT_FALSE(read_kanata(log).ops.empty());
  std::string unpacked(ZSTD_getFrameContentSize(packed.data(), packed.size()), '\0');
  EXPECT_EQ(ZSTD_decompress(unpacked.data(), unpacked.size(), packed.data(), packed.size()), unpacked.size());
  EXPECT_TRUE(unpacked == log);
  EXPECT_FALSE(read_perfetto(trace).empty());
}

TEST_F(TimelineCommand, shows_the_first_5000_cycles_or_the_window) {
  const KanataLog usual = read_kanata(timeline("usual.kanata"));
  EXPECT_EQ(usual.first_cycle, 0u);
  EXPECT_EQ(usual.last_cycle, 5000u);
  const KanataLog window = read_kanata(timeline("window.kanata", "--window 2000:2999"));
  EXPECT_EQ(window.first_cycle, 2000u);
  EXPECT_EQ(window.last_cycle, 3000u);
}

TEST_F(TimelineCommand, is_the_same_whatever_the_mode_and_the_source) {
  const std::string replay = timeline("replay.kanata", "--window 1000:2000");
  EXPECT_TRUE(timeline("exec.kanata", "--window 1000:2000 --source exec --mode pins") == replay);
}

TEST_F(TimelineCommand, refuses_what_it_cannot_show) {
  expect_refused("--timeline a.json", "a.json");
  expect_refused("--timeline a.kanata --window 5", "--window");
  expect_refused("--timeline a.kanata --window 0:1000000", "--window");
  expect_refused("--timeline a.kanata --window 90000000:90000001", "the run was over after");
  expect_refused("--timeline a.kanata --engine reference", "--timeline");
  expect_refused("--timeline nowhere/a.kanata", "nowhere");
}

}  // namespace
}  // namespace ctu::test
