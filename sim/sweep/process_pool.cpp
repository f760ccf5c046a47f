#include "sim/sweep/process_pool.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <fstream>
#include <list>
#include <system_error>
#include <utility>
#include <vector>

namespace ctu::sweep {
namespace {

using Clock = std::chrono::steady_clock;

/// The reading end of what a process says.
class Listener {
 public:
  Listener() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    read_ = ends[0];
    write_ = ends[1];
  }
  ~Listener() {
    close_writing();
    if (read_ >= 0) ::close(read_);
  }
  Listener(Listener&& other) noexcept
      : read_(std::exchange(other.read_, -1)), write_(std::exchange(other.write_, -1)), text_(std::move(other.text_)) {}
  Listener& operator=(Listener&&) = delete;

  void close_writing() {
    if (write_ >= 0) ::close(write_);
    write_ = -1;
  }
  int writing_end() const { return write_; }
  /// -1 at its end.
  int reading_end() const { return read_; }
  /// What is there to be read; of more than `most` bytes the end.
  void listen(std::size_t most) {
    char buffer[65536];
    const ssize_t got = ::read(read_, buffer, sizeof buffer);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) return;
    if (got <= 0) {
      ::close(read_);
      read_ = -1;
      return;
    }
    text_.append(buffer, static_cast<std::size_t>(got));
    if (text_.size() > most) text_.erase(0, text_.size() - most);
  }
  std::string take() { return std::move(text_); }

 private:
  int read_ = -1, write_ = -1;
  std::string text_;
};

struct Running {
  std::size_t piece;
  pid_t process;
  Listener returned, errors;
  Clock::time_point begun;
  bool timed_out = false;
};

std::uint64_t address_space_bytes() {
  std::ifstream in("/proc/self/statm");
  std::uint64_t pages = 0;
  in >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// In the new process: ends with that from which it came, takes no keyboard, says nothing on the terminal.
void become_worker(const PoolLimits& limits, pid_t parent, const Listener& errors) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(0);
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(errors.writing_end(), STDERR_FILENO);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  if (limits.bytes == 0) return;
  const rlim_t most = address_space_bytes() + limits.bytes;
  const rlimit memory{most, most};
  ::setrlimit(RLIMIT_AS, &memory);
}

/// All of it, or as much as the other end takes.
void hand_over(int descriptor, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = ::write(descriptor, text.data() + done, text.size() - done);
    if (written < 0 && errno != EINTR) ::_exit(1);
    if (written > 0) done += static_cast<std::size_t>(written);
  }
}

class Pool {
 public:
  Pool(const PoolWork& work, const PoolLimits& limits, const std::function<bool()>& stop)
      : work_(work), limits_(limits), stop_(stop), killed_before_(work.count, false) {
    for (std::size_t i = 0; i < work.count; ++i) waiting_.push_back(i);
  }
  ~Pool() { kill_all(); }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  std::size_t run() {
    while (!stop_() && (!waiting_.empty() || !running_.empty())) {
      while (!waiting_.empty() && running_.size() < static_cast<std::size_t>(std::max(1, limits_.jobs)) && !stop_())
        begin();
      wait_and_listen();
      for (auto at = running_.begin(); at != running_.end();) {
        const auto next = std::next(at);
        if (at->returned.reading_end() < 0 && at->errors.reading_end() < 0) finish(at);
        at = next;
      }
    }
    return ended_;
  }

 private:
  void begin() {
    const std::size_t piece = waiting_.front();
    waiting_.pop_front();
    work_.prepare(piece);
    Listener returned, errors;
    std::fflush(nullptr);  // or the child would write it a second time
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (process == 0) {
      become_worker(limits_, parent, errors);
      int code = 0;
      try {
        hand_over(returned.writing_end(), work_.run(piece));
      } catch (...) {
        code = work_.on_exception(piece);
      }
      std::fflush(stderr);
      ::_exit(code);
    }
    returned.close_writing();
    errors.close_writing();
    running_.push_back({piece, process, std::move(returned), std::move(errors), Clock::now(), false});
  }

  void wait_and_listen() {
    constexpr std::size_t kMostReturned = std::size_t{1} << 28, kMostErrors = 8192;
    constexpr int kPollMilliseconds = 100;  // how late a time limit, or a stop between two signals, is noticed
    std::vector<pollfd> ends;
    for (const Running& r : running_) {
      ends.push_back({r.returned.reading_end(), POLLIN, 0});
      ends.push_back({r.errors.reading_end(), POLLIN, 0});
    }
    ::poll(ends.data(), ends.size(), kPollMilliseconds);
    auto end = ends.begin();
    for (Running& r : running_) {
      if ((end++)->revents != 0) r.returned.listen(kMostReturned);
      if ((end++)->revents != 0) r.errors.listen(kMostErrors);
      const double seconds = std::chrono::duration<double>(Clock::now() - r.begun).count();
      if (limits_.seconds > 0 && seconds > limits_.seconds && !r.timed_out) {
        r.timed_out = true;
        ::kill(r.process, SIGKILL);
      }
    }
  }

  void finish(std::list<Running>::iterator at) {
    Running& r = *at;
    int status = 0;
    rusage used{};
    while (::wait4(r.process, &status, 0, &used) < 0 && errno == EINTR) {
    }
    Ended ended;
    ended.returned = r.returned.take();
    ended.errors = r.errors.take();
    ended.seconds = std::chrono::duration<double>(Clock::now() - r.begun).count();
    ended.peak_bytes = static_cast<std::uint64_t>(used.ru_maxrss) * 1024;
    ended.how = r.timed_out                ? Ended::How::TimedOut
                : WIFSIGNALED(status)      ? Ended::How::Signalled
                : WEXITSTATUS(status) != 0 ? Ended::How::Exited
                                           : Ended::How::Returned;
    ended.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    const std::size_t piece = r.piece;
    running_.erase(at);
    if (ended.how == Ended::How::Signalled) {
      if (ended.code == SIGTERM || ended.code == SIGINT || ended.code == SIGHUP) return;
      if (ended.code == SIGKILL && !killed_before_[piece]) {
        killed_before_[piece] = true;
        waiting_.push_back(piece);
        return;
      }
    }
    ++ended_;
    work_.end(piece, ended);
  }

  void kill_all() {
    for (const Running& r : running_) ::kill(r.process, SIGKILL);
    for (const Running& r : running_)
      while (::waitpid(r.process, nullptr, 0) < 0 && errno == EINTR) {
      }
    running_.clear();
  }

  const PoolWork& work_;
  const PoolLimits& limits_;
  const std::function<bool()>& stop_;
  std::deque<std::size_t> waiting_;
  std::list<Running> running_;
  std::vector<bool> killed_before_;
  std::size_t ended_ = 0;
};

}  // namespace

std::size_t run_in_processes(const PoolWork& work, const PoolLimits& limits, const std::function<bool()>& stop) {
  return Pool(work, limits, stop).run();
}

}  // namespace ctu::sweep
