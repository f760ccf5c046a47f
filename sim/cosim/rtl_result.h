// What a run of the RTL unit reports, gathered from its links and accounts in every cycle.
#pragma once

#include <vector>

#include "model/pipeline/accounting.h"
#include "model/pipeline/result.h"
#include "sim/cosim/rtl_run.h"

namespace ctu::cosim {

class RtlObserver {
 public:
  explicit RtlObserver(const RtlParameters& build);
  /// Between RtlRun::begin and end.
  void sample(const RtlUnit& unit);
  /// Hits, cycles, what the links saw, the stages' accounts. What no link shows stays 0: uncertain lanes, dropped
  /// entries, the cycles of a ray by place, the counters of caches and tables.
  pipeline::UnitResult result(const RtlRun& run) const;

 private:
  std::vector<int> stages_;  // places in kStageNames
  std::vector<pipeline::Account> accounts_;
  reference::Counts counts_;
};

/// Runs the unit to the end. Throws pipeline::DeadlockFound when no link moves for watchdog.cycles.
pipeline::UnitResult run_rtl(RtlUnit& unit, const pipeline::UnitConfig& config, const pipeline::Work& work,
                             const std::function<void(std::uint64_t rays_done)>& progress);

}  // namespace ctu::cosim
