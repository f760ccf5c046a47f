#include "sim/tailor/tailor_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/base/parallel.h"
#include "sim/area/area_report.h"
#include "sim/config_file.h"
#include "sim/energy/cost_json.h"
#include "sim/tailor/gate_build.h"

namespace ctu::tailor {
namespace {

using nlohmann::ordered_json;
using sim::RunRecord;

double ratio(double a, double b) { return b == 0 ? 0 : a / b; }
double percent(double after, double before) { return 100 * (ratio(after, before) - 1); }

/// The unit that serves all traces is as large as the largest of them wants it.
template <class Get>
double largest(const std::vector<RunRecord>& records, const Get& get) {
  double most = 0;
  for (const RunRecord& record : records) most = std::max(most, get(record));
  return most;
}
double bits(const RunRecord& r) { return static_cast<double>(r.cost.on_chip_bits); }
double memory(const RunRecord& r) { return r.cost.memory_um2 * 1e-6; }
double gates(const RunRecord& r) { return r.cost.gate_equivalents.value_or(0); }
double area(const RunRecord& r) { return r.cost.area_um2.value_or(0) * 1e-6; }

struct Row {
  std::string name, before, after, change;
};

/// Sizes of the unit, then cycles and energy of each trace.
std::vector<Row> rows_of(const TailorResult& result) {
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, double before, double after, const char* format) {
    rows.push_back({name, fmt::format(fmt::runtime(format), before), fmt::format(fmt::runtime(format), after),
                    fmt::format("{:+.2f} %", percent(after, before))});
  };
  const auto size = [&](const char* name, double (*get)(const RunRecord&), const char* format) {
    add(name, largest(result.before, get), largest(result.after, get), format);
  };
  size("on-chip bits", bits, "{:.0f}");
  size("memories, mm2", memory, "{:.4f}");
  const bool known = std::all_of(result.after.begin(), result.after.end(),
                                 [](const RunRecord& r) { return r.cost.gate_equivalents.has_value(); }) &&
                     result.before.front().cost.gate_equivalents.has_value();
  if (known) {
    size("gates, NAND2", gates, "{:.0f}");
    size("area, mm2", area, "{:.4f}");
  } else {
    rows.push_back({"gates, NAND2", energy::kAreaUnknown, energy::kAreaUnknown, ""});
  }
  for (std::size_t i = 0; i < result.before.size(); ++i) {
    const RunRecord &before = result.before[i], &after = result.after[i];
    const std::string scene = before.scene.substr(before.scene.find_last_of('/') + 1);
    add(scene + ": cycles/ray", before.cycles_per_ray(), after.cycles_per_ray(), "{:.3f}");
    add(scene + ": energy, pJ/ray", before.cost.pj_per_ray(), after.cost.pj_per_ray(), "{:.0f}");
  }
  return rows;
}

std::string gate_text(const GateCheck& check) {
  if (!check.not_run.empty()) return "not checked in gates: " + check.not_run;
  return fmt::format("{} rays in gates beside the model: {} cycles, {} handshakes, {}", check.rays, check.cycles,
                     check.handshakes,
                     check.difference.empty() ? fmt::format("no difference, {} wrong hits", check.wrong_hits)
                                              : "first difference: " + check.difference);
}

constexpr const char* kElsewhere =
    "A trace that needs a part which is not there is refused by `ctusim run -c` with the part's name; no configuration "
    "changes a hit.";

}  // namespace

bool TailorResult::is_right() const {
  const auto right = [](const RunRecord& r) { return r.result.wrong_hits == 0 && r.result.other_visits == 0; };
  return std::all_of(before.begin(), before.end(), right) && std::all_of(after.begin(), after.end(), right) &&
         std::all_of(gates.begin(), gates.end(),
                     [](const GateCheck& c) { return c.difference.empty() && c.wrong_hits == 0; });
}

std::vector<std::string> unread_rows(const std::vector<RunRecord>& records) {
  // A row is needed when any trace reads it; which rows that are is not kept, so only one trace can say.
  std::vector<std::string> lines;
  if (records.size() != 1) return lines;
  for (const std::string& line : records.front().result.left_out)
    if (line.find(" rows of ") != std::string::npos) lines.push_back(line + "; the RTL has no choice of single rows");
  return lines;
}

void synthesise(TailorResult& result, const pipeline::UnitConfig& start) {
  area::AreaJob job;
  job.rtl = CTU_RTL_FOLDER;
  job.threads = available_threads();
  job.on_stage = [](const std::string& stage) { fmt::print(stderr, "synthesis: {}\n", stage); };
  const energy::EnergyTable& table = energy::EnergyTable::standard();
  const auto replace = [&](const pipeline::UnitConfig& config, std::vector<RunRecord>& records) {
    job.parameters = gate_parameters(config, result.parts);
    const double found = area::area_of(job).total.gate_equivalents;
    for (RunRecord& record : records) {
      record.cost.gate_equivalents = found;
      record.cost.area_um2 = record.cost.memory_um2 + found * table.at("area.gate");
    }
  };
  replace(start, result.before);
  replace(result.config(), result.after);
}

void print_report(const TailorResult& result) {
  fmt::print("{:<34}{:>18}{:>18}{:>12}\n", "", "before", "tailored", "");
  for (const Row& row : rows_of(result))
    fmt::print("{:<34}{:>18}{:>18}{:>12}\n", row.name, row.before, row.after, row.change);
  fmt::print("\n{:<30}{:>14}{:>14}{:>12}{:>12}   reason\n", "changed", "before", "tailored", "bits", "um2");
  for (const Change& change : result.changes)
    fmt::print("{:<30}{:>14}{:>14}{:>12}{:>12.0f}   {}\n", change.key, change.before, change.after, -change.saved_bits,
               -change.saved_um2, change.reason);
  fmt::print("\nleft out:\n");
  for (const std::string& line : result.missing) fmt::print("  {}\n", line);
  fmt::print("{}\n", kElsewhere);
  if (!result.advice.empty()) fmt::print("\nnot in the unit's choice:\n");
  for (const std::string& line : result.advice) fmt::print("  {}\n", line);
  if (!result.gates.empty()) fmt::print("\n");
  for (const GateCheck& check : result.gates) fmt::print("{}: {}\n", check.trace, gate_text(check));
}

void print_markdown(const TailorResult& result) {
  fmt::print("| | before | tailored | |\n| --- | ---: | ---: | ---: |\n");
  for (const Row& row : rows_of(result))
    fmt::print("| {} | {} | {} | {} |\n", row.name, row.before, row.after, row.change);
  fmt::print("\n| changed | before | tailored | bits | um2 | reason |\n| --- | ---: | ---: | ---: | ---: | --- |\n");
  for (const Change& change : result.changes)
    fmt::print("| `{}` | {} | {} | {} | {:.0f} | {} |\n", change.key, change.before, change.after, -change.saved_bits,
               -change.saved_um2, change.reason);
  fmt::print("\nLeft out:\n\n");
  for (const std::string& line : result.missing) fmt::print("- {}\n", line);
  for (const GateCheck& check : result.gates)
    fmt::print("\n{}: {}.\n", check.trace.substr(check.trace.find_last_of('/') + 1), gate_text(check));
}

std::string report_json(const TailorResult& result) {
  ordered_json json{{"format", "ctusim-tailor"}, {"version", 1}, {"slowdown", result.slowdown}};
  const auto runs = [](const std::vector<RunRecord>& records) {
    ordered_json list = ordered_json::array();
    for (const RunRecord& record : records) {
      ordered_json run{
          {"trace", record.trace_path}, {"trace_hash", record.trace_hash},        {"config_hash", record.config_hash},
          {"rays", record.result.rays}, {"wrong_hits", record.result.wrong_hits}, {"cycles", record.result.cycles}};
      run.update(energy::cost_json(record.cost));
      list.push_back(std::move(run));
    }
    return list;
  };
  json["before"] = runs(result.before);
  json["after"] = runs(result.after);
  ordered_json config;
  for (const pipeline::Parameter& parameter : pipeline::parameters())
    std::visit([&](const auto& value) { config[parameter.key] = value; }, parameter.get(result.config()));
  json["config"] = std::move(config);
  json["parts"] = to_toml(result.parts);
  json["changes"] = ordered_json::array();
  for (const Change& change : result.changes)
    json["changes"].push_back({{"key", change.key},
                               {"before", change.before},
                               {"after", change.after},
                               {"saved_bits", change.saved_bits},
                               {"saved_um2", change.saved_um2},
                               {"gain", change.gain},
                               {"reason", change.reason}});
  json["left_out"] = result.missing;
  json["advice"] = result.advice;
  json["gates"] = ordered_json::array();
  for (const GateCheck& check : result.gates)
    json["gates"].push_back({{"trace", check.trace},
                             {"rays", check.rays},
                             {"cycles", check.cycles},
                             {"handshakes", check.handshakes},
                             {"wrong_hits", check.wrong_hits},
                             {"first_difference", check.difference},
                             {"not_run", check.not_run}});
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace ctu::tailor
