#include "sim/report/share_charts.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sim/report/encoding.h"

namespace ctu::report {
namespace {

using nlohmann::ordered_json;

/// Shown columns that begin so, and their names in the page.
struct Fold {
  std::vector<std::string> columns;
  ordered_json fields = ordered_json::array();
};
Fold fold_of(const Results& results, const std::string& begin, bool (*counts)(const std::string&)) {
  Fold fold;
  for (const std::string& column : page_columns(results))
    if (column.starts_with(begin) && counts(column)) {
      fold.columns.push_back(column);
      fold.fields.push_back(field_of(column));
    }
  return fold;
}

/// stage.X.busy, stage.X.idle, stage.X.stalled.CAUSE; not the sum of causes.
bool is_part_of_stage(const std::string& column) { return !column.ends_with(".stalled"); }
bool is_part_of_sum(const std::string&) { return true; }

/// Means of the columns over the rows shown, in each group, one below the other as `key` and `mean`. Means come first:
/// then no expression is asked more often than there are groups.
ordered_json folded_means(const Fold& fold, const std::vector<std::string>& groups) {
  ordered_json means = ordered_json::array();
  for (const ordered_json& field : fold.fields) means.push_back({{"op", "mean"}, {"field", field}, {"as", field}});
  return ordered_json::array({{{"aggregate", means}, {"groupby", groups}},
                              {{"fold", fold.fields}, {"as", {"key", "mean"}}},
                              {{"filter", "isValid(datum.mean)"}}});
}

/// A column made by an expression.
ordered_json calculated(const std::string& expression, const char* name) {
  return {{"calculate", expression}, {"as", name}};
}

/// Bars of the means, one behind the other.
ordered_json stack(const char* title, const char* format) {
  return {
      {"field", "mean"}, {"type", "quantitative"}, {"stack", "zero"}, {"title", title}, {"axis", {{"format", format}}}};
}

ordered_json word(const char* field, const char* title) {
  return {{"field", field}, {"type", "nominal"}, {"title", title}};
}
ordered_json mean_told(const char* title, const char* format) {
  return {{"field", "mean"}, {"type", "quantitative"}, {"title", title}, {"format", format}};
}

/// Of a plot with so many rows.
int height_of(std::size_t rows) {
  constexpr int kRow = 22, kLeast = 60;
  return std::max(kLeast, kRow * static_cast<int>(rows));
}

/// Busy blue, idle pale, causes in colours of their own.
ordered_json colors_of_activities(const Fold& fold) {
  ordered_json names = {"busy"}, colors = {"#4c78a8"};
  const std::vector<std::string> palette = {"#f58518", "#e45756", "#72b7b2", "#54a24b", "#eeca3b", "#b279a2",
                                            "#ff9da6", "#9d755d", "#79706e", "#d67195", "#439894"};
  for (const std::string& column : fold.columns) {
    const auto stalled = column.find(".stalled.");
    if (stalled == std::string::npos) continue;
    const std::string cause = column.substr(stalled + 9);
    if (std::find(names.begin(), names.end(), cause) != names.end()) continue;
    colors.push_back(palette[(names.size() - 1) % palette.size()]);
    names.push_back(cause);
  }
  names.push_back("idle");
  colors.push_back("#e8e8e8");
  return {{"domain", names}, {"range", colors}};
}

Chart stage_chart(const Fold& fold) {
  Chart chart;
  chart.id = "stages";
  chart.title = "What each stage does";
  chart.caption =
      "Share of all cycles, the mean over the runs shown: busy, stalled by cause, idle. Of a stage that some runs do "
      "not "
      "have, the mean over those that have it.";
  const ordered_json color = colors_of_activities(fold);
  ordered_json stages = ordered_json::array();
  for (const std::string& column : fold.columns)
    if (column.ends_with(".busy")) stages.push_back(column.substr(6, column.size() - 6 - 5));
  chart.spec = new_spec(height_of(stages.size()));
  ordered_json transform = folded_means(fold, {});
  transform.push_back(calculated("split(datum.key, '|')[1]", "stage"));
  transform.push_back(calculated("split(datum.key, '|')[3] || split(datum.key, '|')[2]", "what"));
  transform.push_back(calculated(fmt::format("indexof({}, datum.what)", color["domain"].dump()), "rank"));
  chart.spec["transform"] = std::move(transform);
  ordered_json y = word("stage", "");
  y["title"] = nullptr;
  y["sort"] = stages;
  ordered_json what = word("what", "in the cycle");
  what["scale"] = color;
  chart.spec["mark"] = {{"type", "bar"}};
  chart.spec["encoding"] = {
      {"y", y},
      {"x", stack("share of cycles", ".0%")},
      {"color", what},
      {"order", {{"field", "rank"}, {"type", "ordinal"}}},
      {"tooltip", {word("stage", "stage"), word("what", "in the cycle"), mean_told("share", ".2%")}}};
  chart.spec["encoding"]["x"]["scale"] = {{"domain", {0, 1}}};
  chart.columns = {"scene", "design", "cycles_per_ray"};
  chart.columns.insert(chart.columns.end(), fold.columns.begin(), fold.columns.end());
  return chart;
}

/// A sum by its parts, a bar for each scene and design.
struct Parts {
  const char *id, *title, *caption, *axis;
  const char* begin;  ///< of its columns
  const char* part;   ///< what they are of
};
constexpr Parts kParts[] = {
    {"rays", "Where the time of a ray goes",
     "Cycles of a ray in the unit by place, waiting included, the mean over the runs shown. They are more than cycles "
     "a "
     "ray above, because as many rays are under way as there are contexts.",
     "cycles of a ray", "ray_cycles.", "place"},
    {"energy", "Where the energy of a ray goes",
     "Dynamic energy by stage, the mean over the runs shown; without leakage.", "pJ a ray", "energy.stage.", "stage"},
    {"on-chip", "What is on chip", "Bits of memories and registers by stage, the mean over the runs shown.", "bits",
     "on_chip.", "stage"}};

Chart parts_chart(const Results& results, const Parts& parts, const Fold& fold) {
  Chart chart;
  chart.id = parts.id;
  chart.title = parts.title;
  chart.caption = parts.caption;
  const std::string begin = parts.begin;
  const auto word_number = std::count(begin.begin(), begin.end(), '.');
  chart.spec = new_spec(height_of(values_of(results, "scene").size() * values_of(results, "design").size()));
  ordered_json transform = folded_means(fold, {"scene", "design"});
  transform.push_back(calculated(fmt::format("split(datum.key, '|')[{}]", word_number), "place"));
  transform.push_back(calculated("datum.scene + ', ' + datum.design", "unit"));
  chart.spec["transform"] = std::move(transform);
  ordered_json places = ordered_json::array();
  for (const std::string& column : fold.columns) places.push_back(column.substr(begin.size()));
  ordered_json y = word("unit", "");
  y["title"] = nullptr;
  y["axis"] = {{"labelLimit", 220}};
  ordered_json place = word("place", parts.part);
  place["scale"] = {{"domain", places}, {"scheme", "tableau20"}};
  chart.spec["mark"] = {{"type", "bar"}};
  chart.spec["encoding"] = {
      {"y", y},
      {"x", stack(parts.axis, "~s")},
      {"color", place},
      {"tooltip", {word("unit", "scene, design"), word("place", parts.part), mean_told(parts.axis, ",.4~g")}}};
  chart.columns = {"scene", "design", "cycles_per_ray"};
  chart.columns.insert(chart.columns.end(), fold.columns.begin(), fold.columns.end());
  return chart;
}

ordered_json axis_of(const Results& results, const std::string& column) {
  ordered_json channel = category(results, column);
  channel["type"] = "ordinal";
  channel["axis"] = {{"labelAngle", 0}, {"labelOverlap", true}};
  return channel;
}

Chart heat_map(const Results& results, const std::string& x, const std::string& y) {
  Chart chart;
  chart.id = fmt::format("map-{}-{}", x, y);
  std::replace_if(
      chart.id.begin(), chart.id.end(), [](char c) { return c == '.' || c == '_'; }, '-');
  chart.title = fmt::format("{} and {}", title_of(results, x), title_of(results, y));
  chart.caption = fmt::format(
      "Cycles over the fewest of the same scene, the mean over the runs shown that have both "
      "values. Columns: {}; rows: {}.",
      title_of(results, x), title_of(results, y));
  chart.spec = new_spec(height_of(values_of(results, y).size()));
  chart.spec["mark"] = {{"type", "rect"}};
  ordered_json rows = axis_of(results, y);
  rows["axis"]["title"] = nullptr;
  const ordered_json mean = {
      {"aggregate", "mean"}, {"field", "cycles_over_best"}, {"type", "quantitative"}, {"title", "cycles over best"}};
  ordered_json color = mean;
  color["scale"] = {{"scheme", "viridis"}, {"reverse", true}, {"zero", false}};
  ordered_json told = tooltip(results, {x, y});
  told.push_back(mean);
  told.back()["format"] = ".3f";
  told.push_back({{"aggregate", "count"}, {"type", "quantitative"}, {"title", "runs"}});
  chart.spec["encoding"] = {{"x", axis_of(results, x)}, {"y", rows}, {"color", color}, {"tooltip", told}};
  chart.columns = {x, y, "scene", "cycles_per_ray", "cycles_over_best"};
  return chart;
}

}  // namespace

std::vector<Chart> share_charts(const Results& results) {
  std::vector<Chart> charts;
  if (const Fold stages = fold_of(results, "stage.", is_part_of_stage); !stages.columns.empty())
    charts.push_back(stage_chart(stages));
  for (const Parts& parts : kParts)
    if (const Fold fold = fold_of(results, parts.begin, is_part_of_sum); !fold.columns.empty())
      charts.push_back(parts_chart(results, parts, fold));
  return charts;
}

std::vector<Chart> heat_maps(const Results& results) {
  constexpr std::size_t kMostAxes = 4, kMostValues = 40;
  std::vector<std::string> axes;
  for (const std::string& column : moved_columns(results))
    if (axes.size() < kMostAxes && values_of(results, column).size() <= kMostValues) axes.push_back(column);
  std::vector<Chart> charts;
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::size_t j = i + 1; j < axes.size(); ++j) charts.push_back(heat_map(results, axes[i], axes[j]));
  return charts;
}

}  // namespace ctu::report
