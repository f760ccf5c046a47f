// Energy of a run: what happened, counted by the unit, times what each such event takes.
#pragma once

#include <string>
#include <vector>

#include "model/pipeline/result.h"
#include "sim/energy/energy_table.h"

namespace ctu::energy {

struct UnitShape;

struct EnergyItem {
  std::string stage, item;
  std::string unit;  ///< of what is counted
  double count = 0;
  double pj_each = 0;
  double pj() const { return count * pj_each; }
};

/// Whether the result has the counters that energy is made of: engines cycle, both and estimate.
bool has_event_counts(const pipeline::UnitResult& result);

/// Of every event of the run, stage by stage. Counts are the run's; leaves' best-hit writes and ray boxes count once
/// for every leaf visited, which is at most one too many a leaf.
std::vector<EnergyItem> event_energy(const UnitShape& shape, const pipeline::UnitResult& result,
                                     const EnergyTable& table);

}  // namespace ctu::energy
