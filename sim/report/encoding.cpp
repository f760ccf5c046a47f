#include "sim/report/encoding.h"

#include <map>

namespace ctu::report {
namespace {

using nlohmann::ordered_json;

/// Short words for what is on axes again and again.
const std::map<std::string, std::string>& axis_words() {
  static const std::map<std::string, std::string> words = {
      {"cycles_per_ray", "cycles a ray"},
      {"on_chip_bits", "on-chip bits"},
      {"mask_test.on_chip_bits", "on-chip bits of the mask test"},
      {"mask_test.table_bits", "bits of the mask test's tables"},
      {"area_um2", "area, µm²"},
      {"area_memory_um2", "area of memories, µm²"},
      {"area_gate_equivalents", "gates, NAND2"},
      {"energy_per_ray_pj", "energy a ray, pJ"},
      {"cycles_over_best", "cycles over the scene's best"},
      {"cycles_over_none", "cycles over the best without culling"},
      {"intersections_over_none", "intersections over those without culling"},
      {"intersections_per_ray", "intersections a ray"},
      {"culled_share", "culled share of children hit"}};
  return words;
}

}  // namespace

std::string title_of(const Results& results, const std::string& column) {
  if (const auto words = axis_words().find(column); words != axis_words().end()) return words->second;
  const std::string name = column.starts_with("config.") ? column.substr(7) : column;
  const Column* known = results.find(column);
  return known != nullptr && !known->unit.empty() ? name + ", " + known->unit : name;
}

ordered_json quantity(const Results& results, const std::string& column, bool logarithmic) {
  ordered_json channel = {{"field", field_of(column)}, {"type", "quantitative"}, {"title", title_of(results, column)}};
  if (!logarithmic) {
    channel["scale"] = {{"zero", false}};
    return channel;
  }
  channel["axis"] = {{"labelExpr", "format(datum.value, '.3~s')"}, {"labelOverlap", true}};
  double least = 0;
  bool has_zero = false;
  const auto values = values_of(results, column);
  for (const ordered_json& value : values) {
    if (!value.is_number()) continue;
    has_zero |= value.get<double>() <= 0;
    if (value.get<double>() > 0 && least == 0) least = value.get<double>();
  }
  if (has_zero)
    channel["scale"] = {{"type", "symlog"}, {"constant", least}, {"nice", false}, {"padding", 12}};
  else
    channel["scale"] = {{"type", "log"}, {"nice", false}, {"padding", 12}};
  constexpr std::size_t kMostTicks = 12;
  if (values.size() <= kMostTicks) channel["axis"]["values"] = values;
  return channel;
}

ordered_json category(const Results& results, const std::string& column) {
  ordered_json values = ordered_json::array();
  for (const ordered_json& value : values_of(results, column)) values.push_back(value);
  return {{"field", field_of(column)},
          {"type", "nominal"},
          {"title", title_of(results, column)},
          {"scale", {{"domain", values}}}};
}

ordered_json tooltip(const Results& results, const std::vector<std::string>& columns) {
  ordered_json channels = ordered_json::array();
  for (const std::string& column : columns) {
    const auto values = values_of(results, column);
    const bool number = !values.empty() && values.back().is_number();
    ordered_json channel = {{"field", field_of(column)},
                            {"type", number ? "quantitative" : "nominal"},
                            {"title", title_of(results, column)}};
    if (number) channel["format"] = ",.6~g";
    channels.push_back(channel);
  }
  return channels;
}

ordered_json new_spec(int height) {
  return {{"$schema", "https://vega.github.io/schema/vega-lite/v6.json"},
          {"width", "container"},
          {"height", height},
          {"data", {{"name", "rows"}}}};
}

bool has_numbers(const Results& results, const std::string& column) {
  const auto values = values_of(results, column);
  return values.size() > 1 && values[1].is_number();
}

}  // namespace ctu::report
