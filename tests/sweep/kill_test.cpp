// A sweep that is killed again and again, at random moments, ends as one that nobody disturbed: nothing that was
// recorded is lost or run twice.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/sim/program.h"

namespace {

using ctu::test::read_text;
using ctu::test::run_program;
using ctu::test::ScratchFolder;
using ctu::test::write_text;

constexpr const char* kSpace = R"([[record]]
scene = ["gen:tetra", "gen:hair-ball?strands=60&seed=7"]
rays = "diffuse"
size = "12x8"
[axes]
mask_test.design = ["none", "mask-lut", "projection", "comparators"]
node_cache.bytes = { log2 = [1024, 4096] }
unit.contexts = [4, 16]
)";
constexpr std::size_t kPoints = 2 * 4 * 3 * 2;

std::uint64_t seed_of_run() {
  const char* given = std::getenv("CTU_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 0) : std::random_device()();
}

std::size_t rows_of(const std::filesystem::path& part) {
  if (!std::filesystem::exists(part)) return 0;
  const std::string text = read_text(part);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// `ctusim sweep run` as its own process, ended by `signal` so many milliseconds after its part has so many rows,
/// unless it ends before; its exit code, or minus the signal.
int run_and_end(const std::filesystem::path& folder, int signal, std::size_t rows, int milliseconds) {
  std::fflush(stdout);
  const pid_t process = ::fork();
  if (process == 0) {
    if (::chdir(folder.c_str()) != 0 || std::freopen("out.txt", "w", stdout) == nullptr ||
        std::freopen("err.txt", "w", stderr) == nullptr)
      ::_exit(99);
    ::execl(CTU_PROGRAM, "ctusim", "sweep", "run", "space.toml", "-o", "killed", "-j", "2", nullptr);
    ::_exit(98);
  }
  int status = 0;
  while (rows_of(folder / "killed/parts/local.jsonl") < rows) {
    if (::waitpid(process, &status, WNOHANG) == process)
      return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  ::kill(process, signal);
  ::waitpid(process, &status, 0);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

/// How often each id has a whole line.
std::map<std::string, int> recorded(const std::filesystem::path& part) {
  std::map<std::string, int> lines;
  if (!std::filesystem::exists(part)) return lines;
  const std::string text = read_text(part);
  std::istringstream in(text.substr(0, text.rfind('\n') + 1));
  for (std::string line; std::getline(in, line);) ++lines[nlohmann::json::parse(line).at("id")];
  return lines;
}

class KillTest : public ::testing::Test {
 protected:
  void SetUp() override { write_text(folder_.path() / "space.toml", kSpace); }
  std::filesystem::path part() const { return folder_.path() / "killed/parts/local.jsonl"; }

  /// Nobody disturbs it.
  void run_calm() const { ASSERT_EQ(run_program(folder_.path(), "sweep run space.toml -o calm -j 2").exit_code, 0); }

  /// Ended by `signal` until it comes to its end by itself; then as the one that nobody disturbed.
  void end_again_and_again(int signal, int expected) {
    const std::uint64_t seed = seed_of_run();
    fmt::print("seed {} (CTU_SEED={} runs it again)\n", seed, seed);
    std::mt19937_64 random(seed);
    int ended = 0, amid = 0;
    for (int tries = 0; tries < 20; ++tries) {
      const auto before = recorded(part());
      const int outcome =
          run_and_end(folder_.path(), signal, before.size() + random() % 9, static_cast<int>(random() % 30));
      const auto after = recorded(part());
      for (const auto& [id, lines] : before) EXPECT_EQ(after.count(id), 1u) << "lost: " << id;
      for (const auto& [id, lines] : after) EXPECT_EQ(lines, 1) << "run twice: " << id;
      if (outcome == 0) break;
      ASSERT_EQ(outcome, expected) << read_text(folder_.path() / "err.txt");
      ++ended;
      if (!after.empty() && after.size() < kPoints) ++amid;
    }
    run_calm();
    fmt::print("ended {} times, {} of them between the first and the last point\n", ended, amid);
    EXPECT_GT(amid, 0);
    ASSERT_EQ(run_program(folder_.path(), "sweep run space.toml -o killed -j 2").exit_code, 0);
    EXPECT_EQ(recorded(part()).size(), kPoints);
    for (const auto& [id, lines] : recorded(part())) EXPECT_EQ(lines, 1) << "run twice: " << id;
    for (const char* name : {"results.jsonl", "results.csv", "results.sqlite", "columns.csv"})
      EXPECT_EQ(read_text(folder_.path() / "killed" / name), read_text(folder_.path() / "calm" / name)) << name;
  }

  ScratchFolder folder_;
};

TEST_F(KillTest, killed_at_random_moments_it_loses_and_repeats_nothing) { end_again_and_again(SIGKILL, -SIGKILL); }

TEST_F(KillTest, interrupted_at_random_moments_it_keeps_what_is_done) {
  // Before it listens to the signal it is ended by it as any program.
  const std::uint64_t seed = seed_of_run();
  fmt::print("seed {}\n", seed);
  std::mt19937_64 random(seed);
  for (int tries = 0; tries < 3; ++tries) {
    const auto before = recorded(part());
    const int outcome = run_and_end(folder_.path(), tries == 1 ? SIGTERM : SIGINT, before.size() + 1 + random() % 9,
                                    static_cast<int>(random() % 30));
    const auto after = recorded(part());
    EXPECT_GE(after.size(), before.size());
    if (outcome == 0) break;
    EXPECT_TRUE(outcome == 128 + SIGINT || outcome == 128 + SIGTERM || outcome == -SIGINT || outcome == -SIGTERM)
        << outcome;
    for (const auto& [id, lines] : after) EXPECT_EQ(lines, 1);
  }
  ASSERT_EQ(run_program(folder_.path(), "sweep run space.toml -o killed -j 2").exit_code, 0);
  run_calm();
  EXPECT_EQ(read_text(folder_.path() / "killed/results.jsonl"), read_text(folder_.path() / "calm/results.jsonl"));
}

TEST_F(KillTest, two_runs_do_not_work_in_one_folder) {
  write_text(folder_.path() / "space.toml",
             "[[record]]\nscene = \"gen:tetra\"\nsize = \"4x4\"\n[axes]\nunit.contexts = { range = [1, 256] }\n");
  std::fflush(stdout);
  const pid_t first = ::fork();
  if (first == 0) {
    if (::chdir(folder_.path().c_str()) != 0 || std::freopen("first.txt", "w", stdout) == nullptr) ::_exit(99);
    ::execl(CTU_PROGRAM, "ctusim", "sweep", "run", "space.toml", "-o", "killed", "-j", "1", nullptr);
    ::_exit(98);
  }
  while (!std::filesystem::exists(folder_.path() / "killed/points.jsonl"))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ::kill(first, SIGSTOP);
  const auto second = run_program(folder_.path(), "sweep run space.toml -o killed");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_NE(second.err.find(fmt::format("another sweep works here (process {})", first)), std::string::npos)
      << second.err;
  ::kill(first, SIGKILL);
  ::waitpid(first, nullptr, 0);
}

}  // namespace
