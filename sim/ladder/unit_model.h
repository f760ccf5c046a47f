// How many rays a cycle the unit finishes, in closed form: each stage is a server that a ray occupies for some cycles
// (its demand), the way of a ray through all of them takes a time that grows with the throughput by the waiting in
// front of the servers and at the memory, and by Little's law rays under way = throughput * time. The contexts bound
// the rays under way, so the throughput is where throughput * time(throughput) = contexts.
//
//   waiting  Pollaczek-Khinchine: rate * E[s^2] / (2 (1 - rate * E[s])), less what cannot meet where tokens come one a
//   cycle misses   a full set of miss registers holds the lookups up: Erlang's loss formula memory   a data bus for
//   each channel, a bank for each row, refresh
//
// Sources: Little 1961; Kleinrock 1975, "Queueing systems" I, 5.6; Lazowska, Zahorjan, Graham, Sevcik 1984,
// "Quantitative system performance", ch. 5 (asymptotic bounds).
#pragma once

#include <vector>

#include "model/pipeline/unit_config.h"
#include "sim/ladder/fetch_model.h"
#include "sim/ladder/visit_profile.h"

namespace ctu::ladder {

/// What of the image and the tables is in the unit, and how wide what it fetches is.
struct UnitShape {
  bool decodes_boxes = false, primitive_boxes = false, spheres = false;
  bool mask_test = false, comparators = false, reads_twice = false, table_fetch = false;
  double lines_of_node = 1, lines_of_leaf = 1, lines_of_rows = 1;  ///< on average
};

/// A stage as a server, and a ray's time there, summed over its visits.
struct StageLoad {
  const char* stage = "";
  double cycles = 0;  ///< that a ray occupies its entrance
  double waits = 0;   ///< cycles that a ray waits in front of it
  double stays = 0;   ///< cycles from its entrance to the next stage
};

/// Of a ray of the phase, on average.
struct PhaseEstimate {
  double cycles = 0;          ///< from a ray to the next
  double latency = 0;         ///< in its context
  double memory_latency = 0;  ///< of a line, from the lookup to its return
  double stack_requests = 0, open_rows = 0;
  FetchDemand node, leaf, table;
  std::vector<StageLoad> stages;
  /// The stage that is busy all the time, or "contexts": all are taken, and rays wait for memory and pipelines.
  const char* limit = "";
};

/// Everything of a configuration that phases share.
class UnitModel {
 public:
  UnitModel(const pipeline::UnitConfig& config, const UnitShape& shape);
  PhaseEstimate estimate(const Phase& phase) const;

 private:
  struct Caches {
    CacheModel node, leaf, table;
  };
  /// With so many lines under way to each.
  Caches caches(double nodes, double leaves, double tables) const;

  pipeline::UnitConfig config_;
  UnitShape shape_;
  Caches empty_;
};

}  // namespace ctu::ladder
