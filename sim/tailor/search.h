// The smallest configuration that is not slower than allowed: coordinate descent over the keys that change a unit's
// size, once for each design of the mask test and once for each order in which the keys are tried.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/pipeline/parameter.h"
#include "model/pipeline/unit_config.h"
#include "sim/tailor/workbench.h"

namespace ctu::tailor {

/// A key and the values to try, the one of the starting configuration among them.
struct Dimension {
  std::string key;
  std::vector<pipeline::ParameterValue> values;
};

/// Keys that make a unit smaller, with values up to the start's. Latencies are not among them: a stage of fewer
/// registers would be smaller and, where no clock is modelled, faster. Neither is the memory, which is no part of the
/// unit. `design`: keys of other designs, and of tables where it has none, are left out.
std::vector<Dimension> dimensions_of(const pipeline::UnitConfig& start, cull::Design design);

/// The designs that are tried: those that every trace has masks for.
std::vector<cull::Design> designs_to_try(const Workbench& bench);

/// The configuration with a key's value.
pipeline::UnitConfig with_value(const pipeline::UnitConfig& config, const std::string& key,
                                const pipeline::ParameterValue& value);
pipeline::ParameterValue value_of(const pipeline::UnitConfig& config, const std::string& key);

struct SearchOptions {
  double slowdown = 0.01;      ///< of each trace, against the start
  std::vector<double> ratios;  ///< instead, of each trace: cycles at most, over the start's
  int restarts = 3;            ///< orders of the keys that are tried with the best design
  std::uint64_t seed = 1;      ///< of those behind the first two
  int threads = 1;
  std::function<void(const std::string&)> progress;
};

struct SearchResult {
  pipeline::UnitConfig config;
  double area = 0;  ///< um2, estimated
};

/// The start itself when nothing smaller is fast enough. Throws Error when the start cannot run a trace.
SearchResult find_smallest(Workbench& bench, const pipeline::UnitConfig& start, const SearchOptions& options);

}  // namespace ctu::tailor
