// SIGINT and SIGTERM as a question that is asked between two points.
#pragma once

namespace ctu::sweep {

/// Catches both while it lives.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  static bool received();
  /// As shells have it: 128 and the signal's number.
  static int exit_code();
};

}  // namespace ctu::sweep
