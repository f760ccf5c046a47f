// From the parts of a sweep to tables that other programs read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sim/sweep/columns.h"
#include "sim/sweep/folder.h"
#include "sim/sweep/result_store.h"

namespace ctu::sweep {

struct Table {
  std::vector<nlohmann::ordered_json> rows;  ///< in the order of the points
  std::vector<std::string> columns;          ///< of all rows together, in the order in which rows have them
  std::vector<ColumnNote> notes;             ///< one for each column
};

/// Rows of the points that have a line.
Table make_table(const std::vector<Point>& points, const StoredResults& results, const ColumnNotes& told);

/// What runs said about their columns, from parts/*.columns.jsonl.
ColumnNotes read_notes(const SweepFolder& folder);

std::string to_jsonl(const Table& table);
/// With a header line; text in quotes where it must be (RFC 4180), nothing where a row has no such column.
std::string to_csv(const Table& table);
/// Name, unit and meaning of each column, as CSV.
std::string columns_csv(const Table& table);
/// Tables `results` and `columns`, written anew. Throws Error when it cannot.
void write_sqlite(const Table& table, const std::filesystem::path& file);

/// Writes results.jsonl, results.csv, results.sqlite and columns.csv into the folder.
Table collect(const SweepFolder& folder);

}  // namespace ctu::sweep
