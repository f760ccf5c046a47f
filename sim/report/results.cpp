#include "sim/report/results.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "sim/sweep/collect.h"
#include "sim/sweep/row.h"

namespace ctu::report {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

bool has_result(const ordered_json& row) {
  const std::string status = row.value("status", "");
  return status == sweep::kDone || status == sweep::kWrong;
}

void add_row(Results& results, const ordered_json& row) {
  if (has_result(row))
    results.rows.push_back(row);
  else
    ++results.failed;
}

/// Columns in the order in which rows have them; what runs told of their own is not known here.
void find_columns(Results& results, const sweep::ColumnNotes& told) {
  std::set<std::string> known;
  for (const ordered_json& row : results.rows)
    for (const auto& [key, value] : row.items())
      if (known.insert(key).second) {
        const sweep::ColumnNote note = sweep::note_of(key, told);
        results.columns.push_back({note.name, note.unit, note.meaning});
      }
}

/// What `ctusim sweep collect` wrote, whatever version ran it.
Results read_collected(const fs::path& file) {
  Results results;
  std::istringstream in(read_file(file, kMostBytes, "split the sweep"));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const ordered_json row = ordered_json::parse(line, nullptr, false);
    if (!row.is_object())
      throw Error(fmt::format("{}:{}", file.string(), number), "is no row of a sweep", "run `ctusim sweep collect`");
    add_row(results, row);
  }
  find_columns(results, {});
  return results;
}

Results collect_sweep(const fs::path& folder) {
  const sweep::Table table = sweep::collect(sweep::SweepFolder(folder, false));
  Results results;
  for (const ordered_json& row : table.rows) add_row(results, row);
  for (const sweep::ColumnNote& note : table.notes) results.columns.push_back({note.name, note.unit, note.meaning});
  return results;
}

/// Anew from its parts; as it was collected where this version cannot.
Results read_sweep(const fs::path& folder) {
  const fs::path collected = folder / "results.jsonl";
  if (!fs::is_directory(folder / "parts")) return read_collected(collected);
  try {
    return collect_sweep(folder);
  } catch (const Error& error) {
    if (!fs::exists(collected)) throw;
    fmt::print(stderr, "{}\n  so the report shows {} as it is\n", error.what(), collected.string());
    return read_collected(collected);
  }
}

/// The row that a sweep would have made of this run; null when the file is not one of `ctusim run --json`.
ordered_json row_of_run(const std::string& text) {
  const ordered_json run = ordered_json::parse(text, nullptr, false);
  if (!run.is_object() || run.value("format", "") != "ctusim-result") return nullptr;
  sweep::Point point;
  point.id = run.value("trace_hash", "").substr(0, 16) + run.value("config_hash", "").substr(0, 16);
  point.engine = run.value("engine", "");
  point.config_hash = run.value("config_hash", "");
  point.trace.name = run.value("trace", "");
  point.trace.hash = run.value("trace_hash", "");
  point.trace.scene = run.value("scene", "");
  if (run.contains("config"))
    for (const auto& [key, value] : run["config"].items())
      point.settings.push_back({key, value.is_string() ? value.get<std::string>() : value.dump()});
  for (const sweep::Setting& setting : point.settings)
    if (setting.key == "mask_test.design") point.design = setting.value;
  ordered_json row = sweep::joined_row(point, sweep::result_line(point, text));
  row["command"] = run.value("command", "");
  for (const char* untold : {"ray_kind", "triangles", "image_bytes", "r", "r_ray", "levels", "lut_entries", "box_bits"})
    row.erase(untold);  // the trace's, which is not read
  return row;
}

Results read_runs(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  Results results;
  sweep::ColumnNotes told;
  for (const fs::path& file : files) {
    const std::string text = read_file(file, kMostBytes, "move it away");
    const ordered_json row = row_of_run(text);
    if (row.is_null()) continue;
    told.merge(sweep::notes_of_run(text));
    results.rows.push_back(row);
  }
  find_columns(results, told);
  return results;
}

/// A unit without a mask test keeps no tables for it.
void add_absent_tables(Results& results) {
  for (const char* column : {"mask_test.table_bits", "mask_test.on_chip_bits"})
    if (results.find(column) != nullptr)
      for (ordered_json& row : results.rows)
        if (row.value("design", "") == "none") row[column] = 0;
}

/// Numbers before words, both in their order.
bool comes_before(const ordered_json& a, const ordered_json& b) {
  if (a.is_number() != b.is_number()) return a.is_number();
  if (a.is_number()) return a.get<double>() < b.get<double>();
  return a.dump() < b.dump();
}

bool is_moved_column(const std::string& name) {
  static const std::set<std::string> kOfTraces = {"ray_kind", "r", "r_ray", "levels", "lut_entries", "box_bits"};
  return name.starts_with("config.") || kOfTraces.contains(name);
}

/// How far a column alone moves the cycles: the largest mean over the smallest of its values.
double effect_of(const Results& results, const std::string& column) {
  std::map<std::string, std::pair<double, int>> sums;
  for (const ordered_json& row : results.rows)
    if (row.contains(column) && row.contains("cycles_over_best")) {
      auto& [sum, count] = sums[row[column].dump()];
      sum += row["cycles_over_best"].get<double>();
      ++count;
    }
  double least = 1e300, most = 0;
  for (const auto& [value, sum] : sums) {
    least = std::min(least, sum.first / sum.second);
    most = std::max(most, sum.first / sum.second);
  }
  return most / least;
}

/// `name` of each row: `column` over the least of its scene's rows that `counts` takes.
template <class Counts>
void add_ratio(Results& results, const std::string& name, const std::string& column, const std::string& meaning,
               Counts&& counts) {
  const auto group_of = [](const ordered_json& row) {
    return row.value("scene", "") + "\n" + row.value("ray_kind", "") + "\n" +
           (row.contains("ray_kind") ? "" : row.value("trace_hash", ""));
  };
  const auto value_of = [&](const ordered_json& row) {
    const auto value = row.find(column);
    return value != row.end() && value->is_number() ? value->get<double>() : 0;
  };
  std::map<std::string, double> least;
  for (const ordered_json& row : results.rows)
    if (const double value = value_of(row); value > 0 && counts(row)) {
      const auto [entry, is_new] = least.try_emplace(group_of(row), value);
      if (!is_new) entry->second = std::min(entry->second, value);
    }
  if (least.empty()) return;
  for (ordered_json& row : results.rows)
    if (const auto entry = least.find(group_of(row)); entry != least.end() && value_of(row) > 0)
      row[name] = value_of(row) / entry->second;
  results.columns.push_back({name, "", meaning});
}

}  // namespace

const Column* Results::find(const std::string& name) const {
  for (const Column& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

Results read_results(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw Error(folder.string(), "there is no such folder",
                "name one that `ctusim sweep` or `ctusim run --json` filled");
  const bool swept = fs::is_directory(folder / "parts") || fs::exists(folder / "results.jsonl");
  Results results = swept ? read_sweep(folder) : read_runs(folder);
  if (results.rows.empty())
    throw Error(folder.string(), "no result in it",
                "name a folder of `ctusim sweep`, or one with files of `ctusim run --json`");
  if (const fs::path ladder = folder / "ladder.json"; fs::exists(ladder)) {
    results.ladder = ordered_json::parse(read_file(ladder, kMostBytes, "move it away"), nullptr, false);
    if (results.ladder.is_discarded())
      throw Error(ladder.string(), "is no JSON", "write it again with `ctusim ladder --out`");
  }
  add_absent_tables(results);
  add_comparisons(results);
  return results;
}

std::vector<ordered_json> values_of(const Results& results, const std::string& column) {
  std::vector<ordered_json> values;
  for (const ordered_json& row : results.rows)
    if (const auto value = row.find(column); value != row.end() && !value->is_null()) values.push_back(*value);
  std::sort(values.begin(), values.end(), comes_before);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<std::string> moved_columns(const Results& results) {
  std::vector<std::pair<double, std::string>> moved;
  for (const Column& column : results.columns)
    if (is_moved_column(column.name) && values_of(results, column.name).size() > 1)
      moved.emplace_back(-effect_of(results, column.name), column.name);
  std::sort(moved.begin(), moved.end());
  std::vector<std::string> names;
  for (auto& [effect, name] : moved) names.push_back(std::move(name));
  return names;
}

void add_comparisons(Results& results) {
  const auto all = [](const ordered_json&) { return true; };
  const auto without = [](const ordered_json& row) { return row.value("design", "") == "none"; };
  add_ratio(results, "cycles_over_best", "cycles_per_ray",
            "cycles a ray over the fewest of all points with this scene and these rays", all);
  add_ratio(results, "cycles_over_none", "cycles_per_ray",
            "cycles a ray over the fewest of all points without culling with this scene and these rays", without);
  add_ratio(results, "intersections_over_none", "intersections_per_ray",
            "intersections a ray over those without culling with this scene and these rays", without);
}

}  // namespace ctu::report
