// `ctusim report`: what it is given and the function that does it.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace ctu::report {

struct ReportArgs {
  std::string folder;     ///< of results
  std::string output;     ///< empty: report.html in the folder
  std::string title;      ///< empty: the folder's name
  std::string libraries;  ///< folder with page.html and node_modules; empty: report/ of the source tree
  bool plain = false;     ///< CSV and gnuplot even where the libraries are
};

int report_command(const ReportArgs& args);

/// `ctusim report` and its options; `exit_code` is set when it was run.
void add_report(CLI::App& app, ReportArgs& args, int& exit_code);

}  // namespace ctu::report
