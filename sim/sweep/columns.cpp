#include "sim/sweep/columns.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "model/pipeline/parameter.h"

namespace ctu::sweep {
namespace {

using nlohmann::ordered_json;

bool begins_with(const std::string& text, const std::string& begin) { return text.rfind(begin, 0) == 0; }

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

ColumnNote note_of_parameter(const std::string& column) {
  const std::string key = column.substr(column.find('.') + 1);
  for (const pipeline::Parameter& parameter : pipeline::parameters())
    if (parameter.key == key) return {column, parameter.unit, parameter.description};
  return {column, "", ""};
}

}  // namespace

const std::vector<ColumnNote>& fixed_columns() {
  static const std::vector<ColumnNote> columns = {
      {"id", "",
       "32 digits that name the point: XXH3-128 of the resolved configuration, the trace, its rays, the engine "
       "and the version of the rows"},
      {"status", "",
       "done; wrong (a hit was not the expected one); without a result: refused, deadlock, out-of-memory, "
       "timeout, crashed"},
      {"scene", "", "short name"},
      {"ray_kind", "", "primary, diffuse, shadow, ao or random"},
      {"trace", "", "file, as the space names it, or in the sweep's folder"},
      {"trace_hash", "", "of the trace's content"},
      {"triangles", "triangles", "of the scene"},
      {"image_bytes", "bytes", "nodes, masks and triangles in memory, as recorded"},
      {"r", "cells", "R: cells per axis of an object mask; 0: no masks"},
      {"r_ray", "cells", "R_ray: cells per axis of the ray's key; 0: no masks"},
      {"levels", "levels", "L: levels below from which masks are made, or inf"},
      {"lut_entries", "entries", "of the compression LUT; 0: masks are not compressed"},
      {"box_bits", "bits", "of a coordinate of a node's boxes"},
      {"engine", "", "what ran: cycle, reference, rtl, ..."},
      {"design", "", "mask_test.design"},
      {"config_hash", "", "of the resolved configuration"},
      {"rays", "rays", "returned and checked"},
      {"wrong_hits", "rays", "whose hit is not the expected one, bit for bit"},
      {"other_visits", "visits", "that are not the recorded ones"},
      {"intersections_per_ray", "tests/ray", "4-wide box tests and primitive tests"},
      {"culled_share", "", "of the children that the box test hit, thrown away by the mask test: 0 to 1"},
      {"cycles", "cycles", "until the last ray has returned"},
      {"cycles_per_ray", "cycles/ray", "cycles over rays"},
      {"event_log_hash", "", "over (cycle, ray, step) of every visit and return"},
      {"ray_latency_cycles_sum", "cycles", "from a ray's entry into its context to its return, summed over rays"},
      {"energy_per_ray_pj", "pJ/ray", "dynamic energy of all stages and memory, and leakage, by the energy table"},
      {"energy.table", "", "the energies' table"},
      {"energy.technology", "", "what the energies are of"},
      {"energy.table_hash", "", "of the table's content"},
      {"energy.clock_mhz", "MHz", "that leakage is counted at"},
      {"energy.dynamic_pj", "pJ", "of all events of the run"},
      {"energy.static_pj", "pJ", "leakage in the run's cycles"},
      {"energy.static_of", "", "what leaks: bits, or bits and gates"},
      {"on_chip_bits", "bits", "of all memories and registers of the unit"},
      {"on_chip_memory_bits", "bits", "of these, in memories"},
      {"area_memory_um2", "um2", "of the memories"},
      {"area_gate_equivalents", "NAND2 gates", "of logic and registers; empty where it is not known without synthesis"},
      {"area_um2", "um2", "of memories and gates; empty where gates are not known"},
      {"approximation.limited_by", "", "engine estimate: what sets the pace"},
      {"message", "", "why there is no result, or what is wrong with it"},
      {"command", "", "that repeats the point, in the sweep's folder"},
  };
  return columns;
}

ColumnNotes notes_of_run(const std::string& run_json) {
  const ordered_json run = ordered_json::parse(run_json);
  ColumnNotes notes;
  const auto add = [&](std::string name, std::string unit, std::string meaning) {
    notes[name] = {name, std::move(unit), std::move(meaning)};
  };
  if (run.contains("counters"))
    for (const ordered_json& counter : run["counters"])
      add(counter.at("name"), counter.at("unit"), counter.at("description"));
  if (run.contains("ray_cycles"))
    for (const ordered_json& cause : run["ray_cycles"])
      add("ray_cycles." + cause.at("name").get<std::string>(), "cycles/ray",
          "where a ray's time goes: " + cause.at("description").get<std::string>());
  if (run.contains("stages"))
    for (const ordered_json& stage : run["stages"])
      for (const ordered_json& cause : stage.at("stalled"))
        add(fmt::format("stage.{}.stalled.{}", stage.at("stage").get<std::string>(),
                        cause.at("name").get<std::string>()),
            "", fmt::format("share of cycles: {}", cause.at("description").get<std::string>()));
  return notes;
}

std::string to_line(const ColumnNote& note) {
  return ordered_json{{"column", note.name}, {"unit", note.unit}, {"meaning", note.meaning}}.dump();
}

ColumnNote note_from_line(const std::string& line) {
  const ordered_json json = ordered_json::parse(line);
  return {json.at("column"), json.at("unit"), json.at("meaning")};
}

ColumnNote note_of(const std::string& column, const ColumnNotes& told) {
  if (const auto at = told.find(column); at != told.end()) return at->second;
  for (const ColumnNote& note : fixed_columns())
    if (note.name == column) return note;
  if (begins_with(column, "config.")) return note_of_parameter(column);
  if (begins_with(column, "energy.stage.")) return {column, "pJ/ray", "dynamic energy of the stage"};
  if (begins_with(column, "on_chip.")) return {column, "bits", "on chip, of the stage's memories and registers"};
  if (begins_with(column, "stage.")) {
    if (ends_with(column, ".busy")) return {column, "", "share of cycles in which the stage worked: 0 to 1"};
    if (ends_with(column, ".stalled")) return {column, "", "share of cycles in which it had work and was held up"};
    if (ends_with(column, ".idle")) return {column, "", "share of cycles in which it had nothing to do"};
  }
  return {column, "", ""};
}

}  // namespace ctu::sweep
