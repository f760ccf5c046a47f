// Runs points of a sweep on this machine and appends what came of them: the local pool, and a task of a job array.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/sweep/folder.h"
#include "sim/sweep/process_pool.h"

namespace ctu::sweep {

struct WorkReport {
  std::size_t done = 0;    ///< points that ended, one way or another
  std::size_t failed = 0;  ///< of these, without a right result
};

/// Runs all of `points` into parts/`part`.jsonl. `progress` is told how many have ended.
WorkReport run_points(const SweepFolder& folder, const std::vector<Point>& points, const std::string& part,
                      const PoolLimits& limits, const std::function<bool()>& stop,
                      const std::function<void(std::size_t)>& progress);

}  // namespace ctu::sweep
