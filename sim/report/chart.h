// The plots of a report: each a Vega-Lite specification over the page's rows, and the columns of the table behind it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sim/report/results.h"

namespace ctu::report {

struct Chart {
  std::string id;  ///< of its place in the page
  std::string title, caption;
  nlohmann::ordered_json spec;       ///< without the data when they are the page's rows
  std::vector<std::string> columns;  ///< of its table: names of the rows' columns
  nlohmann::ordered_json rows;       ///< its own data; null: the page's rows, which filters change
  std::string renderer = "svg";      ///< "canvas" where there are thousands of marks
};

/// A column's name in the page: Vega reads dots as ways into objects.
std::string field_of(const std::string& column);

/// Those for which the rows have columns: cycles against on-chip bits, area and energy; sizes of tables; what stages
/// and rays spend their cycles on; maps of two parameters; error against run time.
std::vector<Chart> make_charts(const Results& results);

/// Columns that plots and the page's list of points show.
std::vector<std::string> page_columns(const Results& results);

}  // namespace ctu::report
