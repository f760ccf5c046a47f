#include "sim/sweep/collect.h"

#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "sim/sweep/row.h"

namespace ctu::sweep {
namespace {

using nlohmann::ordered_json;

constexpr const char* kNotes = ".columns.jsonl";

/// Columns that are new are put behind the one that they follow in this row.
void add_columns(const ordered_json& row, std::vector<std::string>& columns) {
  auto place = columns.begin();
  for (const auto& [key, value] : row.items()) {
    const auto known = std::find(columns.begin(), columns.end(), key);
    place = known != columns.end() ? known + 1 : columns.insert(place, key) + 1;
  }
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

Table make_table(const std::vector<Point>& points, const StoredResults& results, const ColumnNotes& told) {
  Table table;
  for (const Point& point : points)
    if (const auto at = results.line_of.find(point.id); at != results.line_of.end())
      table.rows.push_back(joined_row(point, at->second));
  for (const ordered_json& row : table.rows) add_columns(row, table.columns);
  for (const std::string& column : table.columns) table.notes.push_back(note_of(column, told));
  return table;
}

ColumnNotes read_notes(const SweepFolder& folder) {
  ColumnNotes notes;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder.parts()))
    if (entry.path().filename().string().find(kNotes) != std::string::npos) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    std::istringstream in(read_file(file, std::uint64_t{1} << 30, "move the file away"));
    for (std::string line; std::getline(in, line);) try {
        const ColumnNote note = note_from_line(line);
        notes[note.name] = note;
      } catch (const nlohmann::json::exception&) {
        continue;  // torn; the same note is in other parts or comes again
      }
  }
  return notes;
}

std::string to_jsonl(const Table& table) {
  std::string text;
  for (const ordered_json& row : table.rows)
    text += row.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  return text;
}

std::string to_csv(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i != 0) text += ",";
    text += csv_cell(table.columns[i]);
  }
  text += "\n";
  for (const ordered_json& row : table.rows) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (i != 0) text += ",";
      const auto cell = row.find(table.columns[i]);
      if (cell == row.end() || cell->is_null()) continue;
      text += csv_cell(cell->is_string() ? cell->get<std::string>() : cell->dump());
    }
    text += "\n";
  }
  return text;
}

std::string columns_csv(const Table& table) {
  std::string text = "column,unit,meaning\n";
  for (const ColumnNote& note : table.notes)
    text += csv_cell(note.name) + "," + csv_cell(note.unit) + "," + csv_cell(note.meaning) + "\n";
  return text;
}

Table collect(const SweepFolder& folder) {
  Table table = make_table(folder.read_points(), read_results(folder), read_notes(folder));
  folder.replace(folder.path() / "results.jsonl", to_jsonl(table));
  folder.replace(folder.path() / "results.csv", to_csv(table));
  folder.replace(folder.path() / "columns.csv", columns_csv(table));
  write_sqlite(table, folder.path() / "results.sqlite");
  return table;
}

}  // namespace ctu::sweep
