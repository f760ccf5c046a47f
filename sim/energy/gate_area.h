// Gates of a unit without synthesis: what `tools/gate_area.py` has synthesised, stage by stage (gate_area.csv). Stages
// of arithmetic are there by the parameters they depend on, stages of control as sums over contexts, miss registers,
// ways and stack entries fitted to a few syntheses.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace ctu::energy {

struct UnitShape;

struct GateArea {
  double gate_equivalents = 0;
  std::vector<std::string> unknown;  ///< stages that the table does not have with these parameters; the nearest are in
                                     ///< the sum instead
  bool is_known() const { return unknown.empty(); }
};

class GateTable {
 public:
  /// gate_area.csv as it is committed.
  static const GateTable& standard();
  explicit GateTable(const std::string& csv);

  /// Logic and registers in NAND2 gates, memories apart, as `ctusim area` weighs them.
  GateArea of(const UnitShape& shape) const;
  /// Of one stage; `known` is cleared when the nearest row stands for it.
  double stage(const std::string& stage, const std::string& parameters, bool& known) const;

 private:
  double fitted(const std::string& stage, const std::vector<double>& terms) const;

  std::map<std::string, std::map<std::string, double>> rows_;  ///< by stage and parameters
  std::map<std::string, std::vector<double>> coefficients_;    ///< by stage
  double link_bit_ = 0;                                        ///< of a link's registers
};

/// The text of gate_area.csv.
const char* gate_area_text();

}  // namespace ctu::energy
