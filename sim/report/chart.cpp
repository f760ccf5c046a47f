#include "sim/report/chart.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sim/report/ladder_chart.h"
#include "sim/report/pareto_charts.h"
#include "sim/report/share_charts.h"

namespace ctu::report {
namespace {

bool is_shown(const std::string& name) {
  static const std::vector<std::string> kNames = {"id",
                                                  "scene",
                                                  "ray_kind",
                                                  "trace",
                                                  "engine",
                                                  "design",
                                                  "r",
                                                  "r_ray",
                                                  "levels",
                                                  "lut_entries",
                                                  "box_bits",
                                                  "rays",
                                                  "wrong_hits",
                                                  "cycles",
                                                  "cycles_per_ray",
                                                  "intersections_per_ray",
                                                  "culled_share",
                                                  "on_chip_bits",
                                                  "mask_test.table_bits",
                                                  "mask_test.on_chip_bits",
                                                  "config_hash",
                                                  "trace_hash",
                                                  "command"};
  static const std::vector<std::string> kBeginnings = {"config.", "stage.",        "ray_cycles.",
                                                       "energy_", "energy.stage.", "on_chip.",
                                                       "area_",   "cycles_over_",  "intersections_over_"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() ||
         std::any_of(kBeginnings.begin(), kBeginnings.end(),
                     [&](const auto& begin) { return name.starts_with(begin); });
}

/// A stage's cause that never stood in the way would only fill legends.
bool is_ever_other_than_zero(const Results& results, const std::string& name) {
  static const std::vector<std::string> kParts = {"stage.", "ray_cycles.", "energy.stage.", "on_chip."};
  if (std::none_of(kParts.begin(), kParts.end(), [&](const auto& begin) { return name.starts_with(begin); }))
    return true;
  return std::any_of(results.rows.begin(), results.rows.end(), [&](const nlohmann::ordered_json& row) {
    const auto value = row.find(name);
    return value != row.end() && value->is_number() && value->get<double>() != 0;
  });
}

}  // namespace

std::string field_of(const std::string& column) {
  std::string field = column;
  std::replace(field.begin(), field.end(), '.', '|');
  return field;
}

std::vector<std::string> page_columns(const Results& results) {
  std::vector<std::string> names;
  for (const Column& column : results.columns)
    if (is_shown(column.name) && is_ever_other_than_zero(results, column.name)) names.push_back(column.name);
  return names;
}

std::vector<Chart> make_charts(const Results& results) {
  std::vector<Chart> charts = pareto_charts(results);
  for (auto& more : {table_size_charts(results), share_charts(results), heat_maps(results), ladder_charts(results)})
    charts.insert(charts.end(), more.begin(), more.end());
  return charts;
}

}  // namespace ctu::report
