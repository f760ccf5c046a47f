// Work in processes of their own, a few at a time: what one of them does to itself leaves the others alone, and memory
// that was filled before the fork is shared.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace ctu::sweep {

struct PoolLimits {
  int jobs = 1;
  double seconds = 0;       ///< of the clock on the wall, for one piece of work; 0: none
  std::uint64_t bytes = 0;  ///< of address space, beyond what there was at the fork; 0: none
};

/// How a piece of work ended.
struct Ended {
  enum class How : std::uint8_t { Returned, Exited, Signalled, TimedOut };
  How how = How::Returned;
  int code = 0;          ///< exit code, or the signal
  std::string returned;  ///< what the work returned
  std::string errors;    ///< the end of what it wrote to stderr
  double seconds = 0;
  std::uint64_t peak_bytes = 0;  ///< of its resident memory
};

struct PoolWork {
  std::size_t count = 0;
  std::function<void(std::size_t)> prepare;            ///< in this process, before the fork
  std::function<std::string(std::size_t)> run;         ///< in its own process; what it returns is handed over
  std::function<int(std::size_t)> on_exception;        ///< there, within a catch: writes to stderr, gives the exit code
  std::function<void(std::size_t, const Ended&)> end;  ///< in this process, in the order in which they end
};

/// Runs all pieces in order, `limits.jobs` at a time. When `stop` says so no more are begun and those under way are
/// killed without a word to `end`. They are also killed when this process dies, whatever kills it. One that was ended
/// by SIGINT, SIGTERM or SIGHUP from outside counts as not run; one by SIGKILL is run a second time before it counts.
/// Returns how many pieces ended.
std::size_t run_in_processes(const PoolWork& work, const PoolLimits& limits, const std::function<bool()>& stop);

}  // namespace ctu::sweep
