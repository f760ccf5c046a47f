// A sweep under way: points that are planned, run where they are to be run, and what came of them.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "sim/sweep/expand.h"
#include "sim/sweep/process_pool.h"
#include "sim/sweep/result_store.h"
#include "sim/sweep/sweep_command.h"

namespace ctu::sweep {

bool is_on_slurm(const SweepArgs& args);
/// Throws Error on a runner that is not there and on options of another.
void require_runner(const SweepArgs& args);
PoolLimits limits_of(const SweepArgs& args);

class SweepRun {
 public:
  /// `facts` of every trace of the space.
  SweepRun(const SweepArgs& args, const Space& space, const SweepFolder& folder, std::vector<TraceFacts> facts);

  /// Plans these too, and runs what the folder does not hold. Fewer have a result behind it when it was stopped.
  void run(const std::vector<Candidate>& candidates);

  const Space& space() const { return space_; }
  const SweepFolder& folder() const { return folder_; }
  /// All that were planned, in their order.
  const std::vector<Point>& points() const { return points_; }
  const StoredResults& results() const { return results_; }
  std::vector<Point> points_of(const Candidate& candidate) const { return expander_.points(candidate, facts_); }

 private:
  void plan(const std::vector<Candidate>& candidates);
  void run_missing();
  std::vector<Point> missing(const StoredResults& results, bool retry_failed) const;

  const SweepArgs& args_;
  const Space& space_;
  const SweepFolder& folder_;
  Expander expander_;
  std::vector<TraceFacts> facts_;
  std::vector<Point> points_;
  std::set<std::string> planned_;  ///< their ids
  StoredResults results_;
};

}  // namespace ctu::sweep
