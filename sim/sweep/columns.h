// What the columns of results mean: unit and a sentence for each.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace ctu::sweep {

struct ColumnNote {
  std::string name, unit, meaning;
};
using ColumnNotes = std::map<std::string, ColumnNote>;  ///< by name

/// Columns that rows have whatever runs: docs/sweeps.md shows this list.
const std::vector<ColumnNote>& fixed_columns();

/// A line for each column whose meaning is told by the run itself: counters, causes of stalls and of waiting. From the
/// JSON that `ctusim run --json` writes.
ColumnNotes notes_of_run(const std::string& run_json);

std::string to_line(const ColumnNote& note);
/// Throws nlohmann's exceptions on what is no note.
ColumnNote note_from_line(const std::string& line);

/// From the fixed columns, the unit's parameters (config.KEY), stages, or `told`. Unit and meaning are empty when
/// nobody says what it is.
ColumnNote note_of(const std::string& column, const ColumnNotes& told);

}  // namespace ctu::sweep
