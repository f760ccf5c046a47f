// Time since construction.
#pragma once

#include <ctime>

#include <chrono>

namespace ctu::sim {

/// Of the clock on the wall.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Of the processor: other programs' turns are not counted, what they do to the caches is.
template <clockid_t kClock>
class ProcessorStopwatch {
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now() {
    timespec t{};
    clock_gettime(kClock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double start_ = now();
};
using ThreadStopwatch = ProcessorStopwatch<CLOCK_THREAD_CPUTIME_ID>;
using ProcessStopwatch = ProcessorStopwatch<CLOCK_PROCESS_CPUTIME_ID>;  ///< all threads together

}  // namespace ctu::sim
