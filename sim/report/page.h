// The page itself: one HTML file that holds its data, its plots and the libraries that draw them, and asks the network
// for nothing.
#pragma once

#include <filesystem>
#include <string>

#include "sim/report/chart.h"

namespace ctu::report {

/// Whether the libraries are in folder/node_modules (`npm ci` in the folder puts them there).
bool has_libraries(const std::filesystem::path& folder);

/// Throws Error when a file of `folder` is missing.
std::string make_page(const Results& results, const std::vector<Chart>& charts, const std::string& title,
                      const std::filesystem::path& folder);

/// Text as it stands in HTML.
std::string escaped(const std::string& text);

}  // namespace ctu::report
