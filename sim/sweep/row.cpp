#include "sim/sweep/row.h"

#include <unistd.h>

#include <array>
#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace ctu::sweep {
namespace {

using nlohmann::ordered_json;

/// Of the run's JSON: told by the point itself, or timed, and so no part of a row.
bool is_no_result(const std::string& key) {
  static constexpr std::array kNoResults = {"format",          "version",
                                            "tool_version",    "command",
                                            "engine",          "mode",
                                            "source",          "trace",
                                            "trace_hash",      "scene",
                                            "config_hash",     "config",
                                            "wall_seconds",    "processor_seconds",
                                            "rays_per_second", "simulated_cycles_per_second",
                                            "left_out",        "stages",
                                            "counters",        "ray_cycles"};
  for (const char* known : kNoResults)
    if (key == known) return true;
  return false;
}

double share(const ordered_json& part, double whole) { return whole == 0 ? 0 : part.get<double>() / whole; }

void add_stages(const ordered_json& run, ordered_json& row) {
  if (!run.contains("stages")) return;
  for (const ordered_json& stage : run["stages"]) {
    const std::string name = "stage." + stage.at("stage").get<std::string>();
    const double total = stage.at("total").get<double>();
    row[name + ".busy"] = share(stage.at("busy"), total);
    double stalled = 0;
    for (const ordered_json& cause : stage.at("stalled")) stalled += cause.at("cycles").get<double>();
    row[name + ".stalled"] = total == 0 ? 0 : stalled / total;
    row[name + ".idle"] = share(stage.at("idle"), total);
    for (const ordered_json& cause : stage.at("stalled"))
      row[name + ".stalled." + cause.at("name").get<std::string>()] = share(cause.at("cycles"), total);
  }
}

void add_ray_cycles(const ordered_json& run, ordered_json& row) {
  if (!run.contains("ray_cycles")) return;
  const double rays = run.at("rays").get<double>();
  for (const ordered_json& cause : run["ray_cycles"])
    row["ray_cycles." + cause.at("name").get<std::string>()] = share(cause.at("cycles"), rays);
}

/// Numbers, words and tables of them by dotted names; lists are for reports of single runs.
void add_scalars(const ordered_json& from, const std::string& prefix, ordered_json& row) {
  for (const auto& [key, value] : from.items()) {
    if (prefix.empty() && is_no_result(key)) continue;
    if (key.rfind("area_", 0) == 0 && value.is_string()) continue;  // not known: no number, no cell
    if (value.is_object())
      add_scalars(value, prefix + key + ".", row);
    else if (value.is_primitive())
      row[prefix + key] = value;
  }
}

/// Energy of each stage, and its bits on chip.
void add_costs(const ordered_json& run, ordered_json& row) {
  if (run.contains("energy") && run["energy"].contains("stages"))
    for (const ordered_json& stage : run["energy"]["stages"])
      row["energy.stage." + stage.at("stage").get<std::string>()] = stage.at("pj_per_ray");
  if (!run.contains("on_chip")) return;
  for (const ordered_json& structure : run["on_chip"]) {
    ordered_json& bits = row["on_chip." + structure.at("stage").get<std::string>()];
    bits = (bits.is_null() ? 0 : bits.get<std::uint64_t>()) + structure.at("bits").get<std::uint64_t>();
  }
}

ordered_json metrics(const ordered_json& run) {
  ordered_json row;
  add_scalars(run, "", row);
  add_costs(run, row);
  add_stages(run, row);
  add_ray_cycles(run, row);
  if (run.contains("counters"))
    for (const ordered_json& counter : run["counters"])
      row[counter.at("name").get<std::string>()] = counter.at("value");
  return row;
}

/// What a run to its end must not have; engines that return no rays leave out what they cannot know.
std::string problem_of(const ordered_json& run) {
  const auto count = [&](const char* key) -> std::uint64_t {
    return run.contains(key) && run[key].is_number() ? run[key].get<std::uint64_t>() : 0;
  };
  if (count("wrong_hits") != 0) return fmt::format("{} wrong hits", count("wrong_hits"));
  if (count("other_visits") != 0) return fmt::format("{} visits that are not the recorded ones", count("other_visits"));
  return run.contains("first_difference") ? run["first_difference"].get<std::string>() : std::string();
}

std::string text_of(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

/// As the unit's own type: a number, a truth value or a word.
ordered_json typed(const std::string& value) {
  if (value == "true" || value == "false") return value == "true";
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error == std::errc() && end == value.data() + value.size()) return number;
  return value;
}

}  // namespace

std::string result_line(const Point& point, const std::string& run_json) {
  const ordered_json run = ordered_json::parse(run_json);
  ordered_json row = {{"id", point.id}};
  const std::string problem = problem_of(run);
  row["status"] = problem.empty() ? kDone : kWrong;
  row["message"] = problem;
  row.update(metrics(run));
  return text_of(row);
}

std::string failure_line(const Point& point, const std::string& status, const std::string& message) {
  constexpr std::size_t kMostBytes = 2000;  // a deadlock's report shows every link and stage
  return text_of({{"id", point.id}, {"status", status}, {"message", message.substr(0, kMostBytes)}});
}

bool is_right_line(const std::string& line) { return ordered_json::parse(line).at("status") == kDone; }

std::string timing_line(const Point& point, const std::string& run_json, double seconds, std::uint64_t peak_bytes) {
  ordered_json line = {{"id", point.id}, {"point_seconds", seconds}, {"peak_bytes", peak_bytes}};
  if (!run_json.empty()) {
    const ordered_json run = ordered_json::parse(run_json);
    for (const char* key : {"wall_seconds", "processor_seconds", "rays_per_second", "simulated_cycles_per_second"})
      if (run.contains(key)) line[key] = run[key];
  }
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) == 0) line["host"] = host.data();
  return text_of(line);
}

ordered_json joined_row(const Point& point, const std::string& line) {
  const ordered_json result = ordered_json::parse(line);
  const TraceFacts& t = point.trace;
  ordered_json row = {{"id", point.id},
                      {"status", result.at("status")},
                      {"scene", t.scene},
                      {"ray_kind", t.ray_kind},
                      {"trace", t.name},
                      {"trace_hash", t.hash},
                      {"triangles", t.triangles},
                      {"image_bytes", t.image_bytes},
                      {"r", t.r},
                      {"r_ray", t.r_ray},
                      {"levels", t.levels},
                      {"lut_entries", t.lut_entries},
                      {"box_bits", t.box_bits},
                      {"engine", point.engine},
                      {"design", point.design},
                      {"config_hash", point.config_hash}};
  for (const Setting& setting : point.settings) row["config." + setting.key] = typed(setting.value);
  for (const auto& [key, value] : result.items())
    if (key != "id" && key != "status" && key != "message") row[key] = value;
  row["message"] = result.at("message");
  row["command"] = command_of(point);
  return row;
}

}  // namespace ctu::sweep
