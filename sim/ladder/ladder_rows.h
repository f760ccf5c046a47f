// The rungs of the ladder for one configuration, and what is printed and written of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/ladder/coverage.h"

namespace ctu::ladder {

/// One run.
struct Rung {
  std::string engine;  ///< "estimate", "estimate again", "sampled 2%", "cycle", "rtl"
  double cycles = 0;
  double error = 0;                    ///< of the cycles, relative to those of the reference
  std::optional<double> half_width{};  ///< of a sample's interval, likewise
  double wall_seconds = 0;
  double share = 1;    ///< of the rays that were simulated
  std::string note{};  ///< why there is nothing else
};

/// Cycles of a configuration relative to the first one.
struct Comparing {
  std::string engine;
  double ratio = 0;
  std::optional<double> half_width{};
  double wall_seconds = 0;
};

struct Ladder {
  std::string config;     ///< as the user named it
  std::string reference;  ///< the engine that errors are against: "rtl" or "cycle"
  std::vector<Rung> rungs;
  std::vector<Comparing> comparings;
  std::vector<Coverage> coverages;
  double cycle_seconds = 0;  ///< of the engine "cycle"
};

std::string to_table(const Ladder& ladder, bool markdown);
/// What `--out` writes: a row for each rung, and the script that draws error against run time.
std::string to_csv(const std::vector<Ladder>& ladders);
std::string plot_script(const std::vector<Ladder>& ladders, const std::string& title);

}  // namespace ctu::ladder
