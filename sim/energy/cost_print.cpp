#include "sim/energy/cost_print.h"

#include <map>

#include <fmt/format.h>

#include "sim/energy/cost_json.h"

namespace ctu::energy {
namespace {

void print_energy(const CostReport& report) {
  const double rays = report.rays == 0 ? 1 : report.rays, total = report.total_pj();
  fmt::print("\n{:<18}{:>14}{:>9}   (energy, {})\n", "stage", "pJ/ray", "share %", report.technology);
  const auto row = [&](const std::string& name, double pj) {
    fmt::print("{:<18}{:>14.1f}{:>9.1f}\n", name, pj / rays, total == 0 ? 0 : 100 * pj / total);
  };
  for (const StageEnergy& stage : report.stages()) row(stage.stage, stage.pj);
  row(report.gate_equivalents ? "leakage" : "leakage of bits", report.static_pj);
  row("all", total);
}

void print_bits(const CostReport& report) {
  std::map<std::string, std::uint64_t> stages;
  for (const Structure& structure : report.structures) stages[structure.stage] += structure.bits;
  fmt::print("\non chip: {} bits", report.on_chip_bits);
  const char* separator = " (";
  for (const auto& [stage, bits] : stages) {
    fmt::print("{}{} {}", separator, stage, bits);
    separator = ", ";
  }
  fmt::print(")\n");
}

void print_area(const CostReport& report) {
  fmt::print("area: memories {:.3f} mm2", report.memory_um2 * 1e-6);
  if (report.area_um2)
    fmt::print(", gates {:.0f} NAND2, together {:.3f} mm2\n", *report.gate_equivalents, *report.area_um2 * 1e-6);
  else
    fmt::print("; gates {}\n", kAreaUnknown);
}

}  // namespace

void print_cost(const CostReport& report) {
  if (report.has_energy) print_energy(report);
  print_bits(report);
  print_area(report);
}

}  // namespace ctu::energy
