// A progress bar on a terminal, nothing in a pipe.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace ctu::sim {

class Progress {
 public:
  /// `total` in `unit`s ("rays"); 0 when it is not known.
  Progress(std::string title, std::uint64_t total, std::string unit);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void update(std::uint64_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string title_, unit_;
  std::uint64_t total_;
  bool on_terminal_;
  Clock::time_point started_, last_drawn_;
};

}  // namespace ctu::sim
