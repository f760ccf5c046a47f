// What a report is made of: one row a run, as a sweep or single runs left them in a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace ctu::report {

struct Column {
  std::string name, unit, meaning;
};

struct Results {
  std::vector<nlohmann::ordered_json> rows;  ///< flat: names of columns to numbers and words
  std::vector<Column> columns;               ///< of all rows together
  nlohmann::ordered_json ladder;             ///< of ladder.json, null without one
  std::uint64_t failed = 0;                  ///< points without a result, which are no rows

  const Column* find(const std::string& name) const;
};

/// Of a folder of `ctusim sweep`, whose results are collected anew (or, where another version ran it, taken as they
/// were collected), or of one with files of `ctusim run --json`. Throws Error when there is no result in it.
Results read_results(const std::filesystem::path& folder);

/// Different values of a column, in the order of numbers, words behind them.
std::vector<nlohmann::ordered_json> values_of(const Results& results, const std::string& column);

/// The columns that were moved: parameters of the unit and properties of traces with more than one value, those first
/// that change cycles most.
std::vector<std::string> moved_columns(const Results& results);

/// Adds what plots compare by: `cycles_over_best` and `cycles_over_none`, cycles a ray over the fewest with the same
/// trace's rays, of all points and of those without culling; `intersections_over_none` likewise. Traces of one scene
/// and one kind of rays count as the same, as masks and boxes of other traces of them differ.
void add_comparisons(Results& results);

}  // namespace ctu::report
