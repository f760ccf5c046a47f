#include "sim/report/ladder_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/report/encoding.h"

namespace ctu::report {
namespace {

using nlohmann::ordered_json;

/// What the plot shows of a run; null when there is none, as no build of the unit in gates fits. An exact run has no
/// error to draw on a logarithmic axis, so the axis begins at a hundredth of a percent.
ordered_json point_of(const ordered_json& run, const std::string& config) {
  constexpr double kLeastPercent = 0.01;
  for (const char* number : {"error_percent", "wall_seconds", "cycles"})
    if (!run.contains(number) || !run[number].is_number()) return nullptr;
  const double percent = std::abs(run["error_percent"].get<double>());
  ordered_json point = {{"engine", run.value("engine", "")},
                        {"config", config},
                        {"wall_seconds", run["wall_seconds"]},
                        {"error_percent", run["error_percent"]},
                        {"shown_percent", std::max(percent, kLeastPercent)},
                        {"cycles", run["cycles"]}};
  if (run.contains("half_width_percent")) point["half_width_percent"] = run["half_width_percent"];
  return point;
}

ordered_json points_of(const ordered_json& ladder) {
  ordered_json points = ordered_json::array();
  if (!ladder.is_object() || !ladder.contains("configs")) return points;
  for (const ordered_json& config : ladder["configs"])
    for (const ordered_json& run : config.value("engines", ordered_json::array()))
      if (ordered_json point = point_of(run, config.value("config", "")); !point.is_null())
        points.push_back(std::move(point));
  return points;
}

}  // namespace

std::vector<Chart> ladder_charts(const Results& results) {
  Chart chart;
  chart.rows = points_of(results.ladder);
  if (chart.rows.empty()) return {};
  chart.id = "ladder";
  chart.title = "Error against run time";
  chart.caption = fmt::format(
      "What each engine says of the same {} rays of {}: how far its cycles are off, and how long it took on the "
      "machine "
      "that measured it. Errors below 0.01 % are drawn there. Filters do not apply.",
      results.ladder.value("rays", 0), results.ladder.value("scene", ""));
  chart.spec = new_spec(300);
  chart.spec["mark"] = {{"type", "point"}, {"filled", true}, {"size", 70}};
  const auto channel = [](const char* field, const char* type, const char* title) {
    return ordered_json{{"field", field}, {"type", type}, {"title", title}};
  };
  const auto logarithmic = [](ordered_json channel) {
    channel["scale"] = {{"type", "log"}, {"nice", false}, {"padding", 12}};
    channel["axis"] = {{"format", "~g"}, {"labelOverlap", true}};
    return channel;
  };
  const ordered_json seconds = channel("wall_seconds", "quantitative", "run time, s");
  const ordered_json engine = channel("engine", "nominal", "engine"),
                     config = channel("config", "nominal", "configuration");
  chart.spec["encoding"] = {{"x", logarithmic(seconds)},
                            {"y", logarithmic(channel("shown_percent", "quantitative", "error of cycles, %"))},
                            {"color", engine},
                            {"shape", config},
                            {"tooltip",
                             {engine, config, seconds, channel("error_percent", "quantitative", "error, %"),
                              channel("half_width_percent", "quantitative", "half width of the interval, %")}}};
  chart.columns = {"engine", "config", "wall_seconds", "error_percent", "half_width_percent", "cycles"};
  return {chart};
}

}  // namespace ctu::report
