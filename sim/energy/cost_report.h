// What a run cost: energy by stage, bits on chip, area. Part of every result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/pipeline/result.h"
#include "sim/energy/energy_table.h"
#include "sim/energy/event_energy.h"
#include "sim/energy/on_chip_bits.h"

namespace ctu::energy {

struct StageEnergy {
  std::string stage;
  double pj = 0;
};

struct CostReport {
  std::string table, technology, table_hash;
  double clock_mhz = 0;
  std::vector<Structure> structures;
  std::uint64_t on_chip_bits = 0, memory_bits = 0;
  double memory_um2 = 0;                   ///< of memory_bits
  std::optional<double> gate_equivalents;  ///< of logic and all registers; none: not known without synthesis
  std::optional<double> area_um2;          ///< of memories and gates; none without gates

  bool has_energy = false;        ///< the run counted events
  std::vector<EnergyItem> items;  ///< by event
  double static_pj = 0;           ///< leakage of bits, and of gates where they are known, in the run's cycles
  double rays = 0;

  double dynamic_pj() const;
  double total_pj() const { return dynamic_pj() + static_pj; }
  double pj_per_ray() const { return rays == 0 ? 0 : total_pj() / rays; }
  /// In the order of the pipeline.
  std::vector<StageEnergy> stages() const;
};

/// Of a unit, whatever runs on it.
CostReport cost_of_unit(const UnitShape& shape, const EnergyTable& table);
/// Of a run on it; without energy when the result has no counters.
CostReport cost_of_run(const UnitShape& shape, const pipeline::UnitResult& result, const EnergyTable& table);

}  // namespace ctu::energy
