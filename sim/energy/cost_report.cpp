#include "sim/energy/cost_report.h"

#include <algorithm>

#include "sim/energy/gate_area.h"
#include "sim/energy/unit_shape.h"

namespace ctu::energy {

double CostReport::dynamic_pj() const {
  double sum = 0;
  for (const EnergyItem& item : items) sum += item.pj();
  return sum;
}

std::vector<StageEnergy> CostReport::stages() const {
  std::vector<StageEnergy> stages;
  for (const EnergyItem& item : items) {
    auto found = std::find_if(stages.begin(), stages.end(), [&](const auto& s) { return s.stage == item.stage; });
    if (found == stages.end()) found = stages.insert(stages.end(), {item.stage, 0});
    found->pj += item.pj();
  }
  return stages;
}

CostReport cost_of_unit(const UnitShape& shape, const EnergyTable& table) {
  CostReport report;
  report.table = table.name();
  report.technology = table.technology();
  report.table_hash = table.hash();
  report.clock_mhz = table.at("clock.frequency");
  report.structures = on_chip_structures(shape);
  report.on_chip_bits = bits_of(report.structures);
  report.memory_bits = bits_of(report.structures, Keeping::Memory);
  report.memory_um2 = static_cast<double>(report.memory_bits) * table.at("area.memory_bit");
  const GateArea gates = GateTable::standard().of(shape);
  if (gates.is_known()) {
    report.gate_equivalents = gates.gate_equivalents;
    report.area_um2 = report.memory_um2 + gates.gate_equivalents * table.at("area.gate");
  }
  return report;
}

CostReport cost_of_run(const UnitShape& shape, const pipeline::UnitResult& result, const EnergyTable& table) {
  CostReport report = cost_of_unit(shape, table);
  report.rays = static_cast<double>(result.rays);
  report.has_energy = has_event_counts(result);
  if (!report.has_energy) return report;
  report.items = event_energy(shape, result, table);
  // Registers are among the gates, where these are known.
  const std::uint64_t bits = report.gate_equivalents ? report.memory_bits : report.on_chip_bits;
  const double nanowatts = static_cast<double>(bits) * table.at("leakage.memory_bit") +
                           report.gate_equivalents.value_or(0) * table.at("leakage.gate");
  report.static_pj = table.leakage_pj(nanowatts, static_cast<double>(result.cycles));
  return report;
}

}  // namespace ctu::energy
