#include "sim/report/pareto_charts.h"

#include <fmt/format.h>

#include "sim/report/encoding.h"

namespace ctu::report {
namespace {

using nlohmann::ordered_json;

/// The first of `columns` that has numbers; empty: none.
std::string first_with_numbers(const Results& results, const std::vector<std::string>& columns) {
  for (const std::string& column : columns)
    if (has_numbers(results, column)) return column;
  return "";
}

/// Keeps the rows of each scene that no row with at most as much of `cost` reaches in cycles. Two windows, as a window
/// of Vega cannot end before the row it belongs to.
ordered_json front_of(const std::string& cost) {
  const ordered_json order = {{{"field", cost}, {"order", "ascending"}},
                              {{"field", "cycles_per_ray"}, {"order", "ascending"}}};
  const ordered_json fewest = {{"op", "min"}, {"field", "cycles_per_ray"}, {"as", "fewest"}};
  const ordered_json before = {{"op", "lag"}, {"field", "fewest"}, {"param", 1}, {"as", "fewest_before"}};
  const auto window = [&](const ordered_json& what) {
    return ordered_json{{"sort", order},
                        {"window", ordered_json::array({what})},
                        {"frame", {nullptr, 0}},
                        {"ignorePeers", true},
                        {"groupby", {"scene"}}};
  };
  return ordered_json::array(
      {{{"filter", fmt::format("isValid(datum['{}'])", cost)}},
       window(fewest),
       window(before),
       {{"filter", "!isValid(datum.fewest_before) || datum.cycles_per_ray < datum.fewest_before"}}});
}

std::vector<std::string> told_columns(const Results& results) {
  std::vector<std::string> columns = {"scene", "design"};
  for (const std::string& moved : moved_columns(results))
    if (moved != "config.mask_test.design") columns.push_back(moved);
  return columns;
}

Chart pareto(const Results& results, const std::string& id, const std::string& cost, const std::string& what) {
  std::vector<std::string> told = told_columns(results);
  told.insert(told.end(), {"cycles_per_ray", cost});
  const ordered_json x = quantity(results, cost, true), y = quantity(results, "cycles_per_ray", true);
  const ordered_json points = {
      {"params", {{{"name", "brush"}, {"select", {{"type", "interval"}}}}}},
      {"mark", {{"type", "point"}, {"filled", true}, {"size", 40}, {"opacity", 0.7}, {"cursor", "pointer"}}},
      {"encoding",
       {{"x", x},
        {"y", y},
        {"color", category(results, "design")},
        {"shape", category(results, "scene")},
        {"tooltip", tooltip(results, told)}}}};
  const ordered_json front = {
      {"transform", front_of(field_of(cost))},
      {"mark", {{"type", "line"}, {"interpolate", "step-after"}, {"color", "#222"}, {"strokeWidth", 1.5}}},
      {"encoding", {{"x", x}, {"y", y}, {"detail", {{"field", "scene"}, {"type", "nominal"}}}}}};
  Chart chart;
  chart.id = id;
  chart.title = "Cycles against " + what;
  chart.caption =
      "Each point is a run. The staircase of a scene joins the points that no other one beats in both. Drag over "
      "points to "
      "keep only them in all other plots and tables; click one for its configuration, trace and command.";
  chart.spec = new_spec(340);
  chart.spec["layer"] = {points, front};
  chart.columns = told;
  chart.columns.insert(chart.columns.end(), {"intersections_per_ray", "culled_share"});
  constexpr std::size_t kMostVectorMarks = 2000;
  if (results.rows.size() > kMostVectorMarks) chart.renderer = "canvas";
  return chart;
}

Chart table_sizes(const Results& results, const std::string& id, const std::string& value, const std::string& title,
                  const std::string& caption) {
  const std::string bits = "mask_test.table_bits";
  ordered_json y = quantity(results, value, false);
  y["aggregate"] = "min";
  y["title"] = "least " + title_of(results, value);
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.caption = caption;
  chart.spec = new_spec(300);
  chart.spec["transform"] = {{{"filter", fmt::format("isValid(datum['{}'])", field_of(bits))}}};
  chart.spec["mark"] = {{"type", "line"}, {"point", {{"size", 45}}}};
  chart.spec["encoding"] = {{"x", quantity(results, bits, true)},
                            {"y", y},
                            {"color", category(results, "scene")},
                            {"strokeDash", category(results, "design")},
                            {"detail", {{"field", "r"}, {"type", "nominal"}}},
                            {"shape", category(results, "design")},
                            {"tooltip", tooltip(results, {"scene", "design", bits})}};
  chart.spec["encoding"]["tooltip"].push_back(y);
  chart.columns = {"scene", "design", "r", "r_ray", "lut_entries", bits, value, "culled_share"};
  return chart;
}

}  // namespace

std::vector<Chart> pareto_charts(const Results& results) {
  std::vector<Chart> charts;
  if (!has_numbers(results, "cycles_per_ray")) return charts;
  const auto add = [&](const std::string& id, const std::vector<std::string>& costs, const std::string& what) {
    if (const std::string cost = first_with_numbers(results, costs); !cost.empty())
      charts.push_back(pareto(results, id, cost, what));
  };
  add("pareto-bits", {"on_chip_bits", "mask_test.on_chip_bits"}, "on-chip bits");
  add("pareto-area", {"area_um2", "area_memory_um2"}, "area");
  add("pareto-energy", {"energy_per_ray_pj"}, "energy");
  return charts;
}

std::vector<Chart> table_size_charts(const Results& results) {
  std::vector<Chart> charts;
  if (!has_numbers(results, "mask_test.table_bits")) return charts;
  const bool compared = results.find("intersections_over_none") != nullptr;
  charts.push_back(
      table_sizes(results, "table-intersections", compared ? "intersections_over_none" : "intersections_per_ray",
                  "What tables of a size save in intersections",
                  "A size of 0 is the box test alone, or comparators, which keep no table. Timing has no part in it: "
                  "points of one trace and one design lie on each other."));
  charts.push_back(table_sizes(
      results, "table-cycles", compared ? "cycles_over_none" : "cycles_per_ray", "What tables of a size save in cycles",
      "The fewest cycles at each size, over everything else that was moved; a line for each R."));
  return charts;
}

}  // namespace ctu::report
