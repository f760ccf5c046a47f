// A report without its libraries: tables as CSV and a script for gnuplot.
#pragma once

#include <filesystem>

#include "sim/report/results.h"

namespace ctu::report {

/// Writes report.csv (a line for each run), report.gp and, when there is a gnuplot, report.svg into the folder: cycles
/// against on-chip bits, and the fewest cycles at each size of the mask test's tables.
void write_plain_files(const Results& results, const std::filesystem::path& folder);

}  // namespace ctu::report
