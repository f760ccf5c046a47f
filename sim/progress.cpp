#include "sim/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace ctu::sim {
namespace {
constexpr int kBarCells = 30;
constexpr auto kRedrawEvery = std::chrono::milliseconds(100);
}  // namespace

Progress::Progress(std::string title, std::uint64_t total, std::string unit)
    : title_(std::move(title)),
      unit_(std::move(unit)),
      total_(total),
      on_terminal_(isatty(STDERR_FILENO) != 0),
      started_(Clock::now()),
      last_drawn_(started_) {}

Progress::~Progress() {
  if (on_terminal_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::update(std::uint64_t done) {
  if (!on_terminal_) return;
  const auto now = Clock::now();
  if (now - last_drawn_ < kRedrawEvery) return;
  last_drawn_ = now;
  const double seconds = std::chrono::duration<double>(now - started_).count();
  const double rate = static_cast<double>(done) / seconds;
  if (total_ == 0) {
    fmt::print(stderr, "\r{} {} {} ({:.3g} {}/s)\x1b[K", title_, done, unit_, rate, unit_);
  } else {
    const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    const int filled = static_cast<int>(share * kBarCells);
    fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3.0f} % {:.3g} {}/s, {:.0f} s left\x1b[K", title_, "", filled, "",
               kBarCells - filled, share * 100, rate, unit_, share > 0 ? seconds / share - seconds : 0);
  }
  std::fflush(stderr);
}

}  // namespace ctu::sim
