// Pieces of Vega-Lite specifications that several plots share.
#pragma once

#include <string>
#include <vector>

#include "sim/report/chart.h"

namespace ctu::report {

/// "cycles a ray", for axes and tables: the column's words where it has few, else its name; the unit behind it.
std::string title_of(const Results& results, const std::string& column);

/// A quantitative channel. `logarithmic`: symlog where the column has a zero.
nlohmann::ordered_json quantity(const Results& results, const std::string& column, bool logarithmic);
/// A nominal channel, its values in the order of numbers.
nlohmann::ordered_json category(const Results& results, const std::string& column);
/// What the pointer shows of a row.
nlohmann::ordered_json tooltip(const Results& results, const std::vector<std::string>& columns);

/// A specification as wide as its place, over the page's rows.
nlohmann::ordered_json new_spec(int height);

/// Whether at least two rows have different numbers there.
bool has_numbers(const Results& results, const std::string& column);

}  // namespace ctu::report
