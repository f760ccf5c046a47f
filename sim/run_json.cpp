#include "sim/run_json.h"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "model/base/version.h"
#include "sim/config_file.h"
#include "sim/energy/cost_json.h"

namespace ctu::sim {
namespace {

using nlohmann::ordered_json;

constexpr int kResultVersion = 1;

ordered_json config_json(const pipeline::UnitConfig& config) {
  ordered_json json;
  for (const auto& parameter : pipeline::parameters())
    std::visit([&](const auto& value) { json[parameter.key] = value; }, parameter.get(config));
  return json;
}

ordered_json causes_json(const std::vector<pipeline::Cause>& causes) {
  ordered_json json = ordered_json::array();
  for (const auto& cause : causes)
    json.push_back({{"name", cause.name}, {"cycles", cause.cycles}, {"description", cause.description}});
  return json;
}

ordered_json counts_json(const reference::Counts& counts) {
  const auto item = [](std::string_view name, std::string_view unit, std::uint64_t value,
                       std::string_view description) {
    return ordered_json{{"name", name}, {"unit", unit}, {"value", value}, {"description", description}};
  };
  return ordered_json::array({
      item("traversal.node_visits", "box tests", counts.node_visits, "4-wide box tests; each counts one intersection"),
      item("traversal.triangle_tests", "triangle tests", counts.triangle_tests, "each counts one intersection"),
      item("traversal.boxed_out", "triangle tests", counts.boxed_out, "saved by ray boxes in the leaves"),
      item("traversal.leaf_visits", "leaves", counts.leaf_visits, "leaves whose triangles were tested"),
      item("traversal.box_hits", "children", counts.box_hits, "children that the box test hit"),
      item("traversal.culled", "children", counts.culled, "box hits thrown away by the mask test"),
      item("traversal.uncertain", "children", counts.uncertain,
           "box hits passed because rounding left two candidate cells"),
      item("traversal.dropped", "entries", counts.dropped, "stack entries dropped at the pop: beyond the best hit"),
  });
}

ordered_json stages_json(const pipeline::UnitResult& result) {
  ordered_json json = ordered_json::array();
  for (const auto& stage : result.stages)
    json.push_back({{"stage", stage.stage},
                    {"busy", stage.busy},
                    {"idle", stage.idle},
                    {"stalled", causes_json(stage.stalled)},
                    {"total", result.cycles}});
  return json;
}

ordered_json counters_json(const pipeline::UnitResult& result) {
  ordered_json json = counts_json(result.counts);
  for (const auto& counter : result.counters)
    json.push_back({{"name", counter.name},
                    {"unit", counter.unit},
                    {"value", counter.value},
                    {"description", counter.description}});
  return json;
}

ordered_json timed_json(const RunRecord& record) {
  ordered_json json;
  json["mode"] = record.mode;
  json["source"] = record.source;
  json["cycles"] = record.result.cycles;
  json["cycles_per_ray"] = record.cycles_per_ray();
  json["simulated_cycles_per_second"] = record.cycles_per_second();
  json["event_log_hash"] =
      record.runs_rays() ? ordered_json(fmt::format("{:016x}", record.result.event_log_hash)) : ordered_json();
  json["stages"] = stages_json(record.result);
  json["ray_latency_cycles_sum"] = record.result.ray_latency_sum;
  json["ray_cycles"] = causes_json(record.result.ray_cycles);
  json["left_out"] = record.result.left_out;
  return json;
}

ordered_json approximation_json(const Approximation& a, const std::string& engine) {
  if (engine == "estimate") return {{"limited_by", a.limit}};
  return {{"confidence_percent", a.confidence}, {"cycles_low", a.cycles_low},
          {"cycles_high", a.cycles_high},       {"chunks", a.chunks},
          {"simulated_rays", a.simulated_rays}, {"simulated_cycles", a.simulated_cycles}};
}

}  // namespace

void check_writable(const std::string& path) {
  if (!std::ofstream(path, std::ios::app))
    throw Error(path, "the result cannot be written there", "check the folder and its permissions");
}

std::string json_text(const RunRecord& record) {
  ordered_json json;
  json["format"] = "ctusim-result";
  json["version"] = kResultVersion;
  json["tool_version"] = tool_version();
  json["command"] = record.command;
  json["engine"] = record.engine;
  json["trace"] = record.trace_path;
  json["trace_hash"] = record.trace_hash;
  json["scene"] = record.scene;
  json["config_hash"] = record.config_hash;
  json["rays"] = record.result.rays;
  json["wrong_hits"] = record.runs_rays() ? ordered_json(record.result.wrong_hits) : ordered_json();
  json["other_visits"] = record.runs_rays() ? ordered_json(record.result.other_visits) : ordered_json();
  json["intersections_per_ray"] = record.result.counts.intersections_per_ray();
  json["culled_share"] = record.result.counts.culled_share();
  json["wall_seconds"] = record.wall_seconds;
  json["processor_seconds"] = record.processor_seconds;
  json["rays_per_second"] = record.rays_per_second();
  if (record.timed()) json.update(timed_json(record));
  if (record.engine == "both") {
    json["handshakes_compared"] = record.twins.handshakes;
    json["signals_compared"] = record.twins.signals;
    json["first_difference"] = record.twins.first_difference;
  }
  if (!record.runs_rays()) json["approximation"] = approximation_json(record.approximation, record.engine);
  json.update(energy::cost_json(record.cost));
  json["counters"] = counters_json(record.result);
  json["config"] = config_json(record.config);
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

void write_json(const RunRecord& record, const std::string& path) {
  std::ofstream out(path);
  out << json_text(record) << '\n';
  if (!out.flush()) throw Error(path, "the result could not be written", "check the folder and the free space");
}

}  // namespace ctu::sim
