// Work in processes: what each did to itself is told, the others never notice.
#include "sim/sweep/process_pool.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <map>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "tests/sim/program.h"

namespace {

using namespace ctu::sweep;

struct Pool {
  PoolWork work;
  PoolLimits limits;
  std::map<std::size_t, Ended> ended;
  std::function<bool()> stop = [] { return false; };

  Pool(std::size_t count, std::function<std::string(std::size_t)> run) {
    work.count = count;
    work.prepare = [](std::size_t) {};
    work.run = std::move(run);
    work.on_exception = [](std::size_t) {
      fmt::print(stderr, "thrown\n");
      return 7;
    };
    work.end = [this](std::size_t i, const Ended& e) {
      EXPECT_EQ(ended.count(i), 0u) << "ended twice";
      ended[i] = e;
    };
    limits.jobs = 3;
  }
  std::size_t run() { return run_in_processes(work, limits, stop); }
};

TEST(ProcessPool, every_piece_hands_over_what_it_returned) {
  const std::string large(300000, 'x');  // more than a pipe holds
  Pool pool(20, [&](std::size_t i) { return std::to_string(i) + large; });
  EXPECT_EQ(pool.run(), 20u);
  ASSERT_EQ(pool.ended.size(), 20u);
  for (const auto& [i, ended] : pool.ended) {
    EXPECT_EQ(ended.how, Ended::How::Returned);
    EXPECT_EQ(ended.returned, std::to_string(i) + large);
  }
}

TEST(ProcessPool, exceptions_exits_and_crashes_are_told_and_the_rest_goes_on) {
  Pool pool(5, [](std::size_t i) -> std::string {
    if (i == 0) throw std::runtime_error("no");
    if (i == 1) ::_exit(3);
    if (i == 2) std::raise(SIGSEGV);
    if (i == 3) std::raise(SIGKILL);
    return "right";
  });
  EXPECT_EQ(pool.run(), 5u);
  EXPECT_EQ(pool.ended[0].how, Ended::How::Exited);
  EXPECT_EQ(pool.ended[0].code, 7);
  EXPECT_EQ(pool.ended[0].errors, "thrown\n");
  EXPECT_EQ(pool.ended[1].code, 3);
  EXPECT_EQ(pool.ended[2].how, Ended::How::Signalled);
  EXPECT_EQ(pool.ended[2].code, SIGSEGV);
  EXPECT_EQ(pool.ended[3].code, SIGKILL);
  EXPECT_EQ(pool.ended[4].returned, "right");
}

TEST(ProcessPool, one_that_was_killed_from_outside_runs_a_second_time) {
  const ctu::test::ScratchFolder folder;
  const std::string mark = (folder.path() / "mark").string();
  Pool pool(1, [&](std::size_t) -> std::string {
    if (::access(mark.c_str(), F_OK) != 0) {
      ctu::test::write_text(mark, "");
      std::raise(SIGKILL);
    }
    return "second";
  });
  EXPECT_EQ(pool.run(), 1u);
  EXPECT_EQ(pool.ended[0].returned, "second");
}

TEST(ProcessPool, one_that_was_asked_to_end_counts_as_not_run) {
  Pool pool(2, [](std::size_t i) -> std::string {
    if (i == 0) std::raise(SIGTERM);
    return "right";
  });
  EXPECT_EQ(pool.run(), 1u);
  EXPECT_EQ(pool.ended.count(0), 0u);
  EXPECT_EQ(pool.ended[1].returned, "right");
}

TEST(ProcessPool, what_takes_too_long_is_ended) {
  Pool pool(2, [](std::size_t i) -> std::string {
    while (i == 0) ::pause();
    return "right";
  });
  pool.limits.seconds = 0.3;
  EXPECT_EQ(pool.run(), 2u);
  EXPECT_EQ(pool.ended[0].how, Ended::How::TimedOut);
  EXPECT_EQ(pool.ended[1].returned, "right");
}

TEST(ProcessPool, memory_beyond_the_limit_is_not_given) {
  Pool pool(2, [](std::size_t i) {
    std::string memory(i == 0 ? std::size_t{1} << 28 : 1, 'x');
    return std::to_string(memory.size());
  });
  pool.limits.bytes = std::uint64_t{1} << 26;
  EXPECT_EQ(pool.run(), 2u);
  EXPECT_EQ(pool.ended[0].code, 7) << "bad_alloc is an exception as any other";
  EXPECT_EQ(pool.ended[1].returned, "1");
}

TEST(ProcessPool, a_stop_ends_what_is_under_way_without_a_word) {
  Pool pool(10, [](std::size_t i) -> std::string {
    while (i >= 3) ::pause();
    return "right";
  });
  pool.stop = [&] { return pool.ended.size() == 3; };
  EXPECT_EQ(pool.run(), 3u);
  EXPECT_EQ(pool.ended.size(), 3u);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "no process is left";
}

TEST(ProcessPool, processes_die_with_the_one_that_began_them) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t owner = ::fork();
  if (owner == 0) {
    Pool pool(1, [&](std::size_t) -> std::string {
      const pid_t self = ::getpid();
      if (::write(ends[1], &self, sizeof self) != sizeof self) ::_exit(1);
      for (;;) ::pause();
    });
    pool.run();
    ::_exit(0);
  }
  pid_t piece = 0;
  ASSERT_EQ(::read(ends[0], &piece, sizeof piece), static_cast<ssize_t>(sizeof piece));
  ::kill(owner, SIGKILL);
  ::waitpid(owner, nullptr, 0);
  ::close(ends[1]);
  char byte = 0;
  EXPECT_EQ(::read(ends[0], &byte, 1), 0) << "the pipe closes when the last process that has it is gone";
  ::close(ends[0]);
}

}  // namespace
