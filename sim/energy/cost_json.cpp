#include "sim/energy/cost_json.h"

namespace ctu::energy {
namespace {

using nlohmann::ordered_json;

ordered_json energy_json(const CostReport& report) {
  const double rays = report.rays == 0 ? 1 : report.rays;
  ordered_json stages = ordered_json::array(), items = ordered_json::array();
  for (const StageEnergy& stage : report.stages())
    stages.push_back({{"stage", stage.stage}, {"pj", stage.pj}, {"pj_per_ray", stage.pj / rays}});
  for (const EnergyItem& item : report.items)
    items.push_back({{"stage", item.stage},
                     {"item", item.item},
                     {"unit", item.unit},
                     {"count", item.count},
                     {"pj_each", item.pj_each},
                     {"pj", item.pj()}});
  return {{"table", report.table},
          {"technology", report.technology},
          {"table_hash", report.table_hash},
          {"clock_mhz", report.clock_mhz},
          {"dynamic_pj", report.dynamic_pj()},
          {"static_pj", report.static_pj},
          {"static_of", report.gate_equivalents ? "bits and gates" : "bits"},
          {"stages", stages},
          {"items", items}};
}

ordered_json structures_json(const std::vector<Structure>& structures) {
  ordered_json json = ordered_json::array();
  for (const Structure& structure : structures)
    json.push_back({{"stage", structure.stage},
                    {"name", structure.name},
                    {"bits", structure.bits},
                    {"kept_in", structure.keeping == Keeping::Memory ? "memory" : "registers"}});
  return json;
}

ordered_json known_or_not(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(kAreaUnknown);
}

}  // namespace

ordered_json cost_json(const CostReport& report) {
  ordered_json json;
  if (report.has_energy) {
    json["energy_per_ray_pj"] = report.pj_per_ray();
    json["energy"] = energy_json(report);
  }
  json["on_chip_bits"] = report.on_chip_bits;
  json["on_chip_memory_bits"] = report.memory_bits;
  json["on_chip"] = structures_json(report.structures);
  json["area_memory_um2"] = report.memory_um2;
  json["area_gate_equivalents"] = known_or_not(report.gate_equivalents);
  json["area_um2"] = known_or_not(report.area_um2);
  return json;
}

}  // namespace ctu::energy
