// What a cache of some size and associativity makes of the lines that a fetch stage is asked for.
#pragma once

#include <array>

#include "model/pipeline/unit_config.h"
#include "sim/ladder/visit_profile.h"

namespace ctu::ladder {

/// Of one ray, on average.
struct FetchDemand {
  double visits = 0, lookups = 0;
  double lines = 0;           ///< that the cache does not hold, asked of memory
  double missing_visits = 0;  ///< with at least one such line
  double cycles = 0;          ///< that lookups take of the entrance, a visit after the other
  double squared_cycles = 0;  ///< their squares
  double open_rows = 0;       ///< of `lines`: those that find their memory row open
};

/// The cache, apart from what it is asked for: computed once for all phases of a trace.
class CacheModel {
 public:
  /// `lines_per_visit`: on average. `lines_under_way`: likewise, that miss registers wait for; they take no place in
  /// the cache until they come, and are found nonetheless.
  CacheModel(const pipeline::CacheConfig& cache, const pipeline::MemoryConfig& memory, int contexts,
             double lines_per_visit, double lines_under_way);

  /// Probability that the cache holds a line of the group when it is looked up.
  double held(int group) const { return held_[static_cast<std::size_t>(group)]; }
  /// Probability that a row is still open when so many other lines, in this bucket, have been asked of memory since.
  double open(int row_bucket) const { return open_[static_cast<std::size_t>(row_bucket)]; }
  int size_class() const { return size_class_; }
  int ports() const { return ports_; }
  /// Without a cache what is found is on its way.
  bool keeps_lines() const { return keeps_lines_; }

 private:
  std::array<double, kGroups> held_{};
  std::array<double, kRowBuckets> open_{};
  int size_class_, ports_;
  bool keeps_lines_;
};

class FetchModel {
 public:
  /// Both must outlive it.
  FetchModel(const LineProfile& profile, const CacheModel& cache, double rays);

  const FetchDemand& demand() const { return demand_; }

  /// Sum over the visits of a ray of the share of `window` that they wait for a line which another ray has asked for
  /// less than `window` visits ago.
  double joined(double window) const;

 private:
  const LineProfile& profile_;
  const CacheModel& cache_;
  double rays_;
  FetchDemand demand_;
};

}  // namespace ctu::ladder
