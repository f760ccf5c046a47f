#include "sim/report/report_command.h"

#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "sim/paper/plot.h"
#include "sim/report/chart.h"
#include "sim/report/page.h"
#include "sim/report/plain_files.h"
#include "sim/report/results.h"

namespace ctu::report {
namespace {

namespace fs = std::filesystem;

std::string title_of_folder(const fs::path& folder) {
  const fs::path whole = fs::weakly_canonical(folder);
  return (whole.has_filename() ? whole.filename() : whole.parent_path().filename()).string();
}

}  // namespace

int report_command(const ReportArgs& args) {
  const fs::path folder = args.folder;
  const Results results = read_results(folder);
  const fs::path libraries = args.libraries.empty() ? fs::path(CTU_REPORT_FOLDER) : fs::path(args.libraries);
  if (args.plain || !has_libraries(libraries)) {
    if (!args.plain)
      fmt::print(stderr,
                 "{}: the libraries that draw the page are not there, so tables and a script for gnuplot are written "
                 "instead.\n  remedy: run `npm ci` there\n",
                 libraries.string());
    write_plain_files(results, folder);
    fmt::print("{}: {} runs as report.csv, plots as report.gp\n", folder.string(), results.rows.size());
    return 0;
  }
  const std::vector<Chart> charts = make_charts(results);
  const fs::path file = args.output.empty() ? folder / "report.html" : fs::path(args.output);
  const std::string title = args.title.empty() ? title_of_folder(folder) : args.title;
  const std::string page = make_page(results, charts, title, libraries);
  sim::paper::write_file(file.parent_path(), file.filename().string(), page);
  fmt::print("{}: {} runs, {} plots, {:.1f} MB\n", file.string(), results.rows.size(), charts.size(),
             static_cast<double>(page.size()) * 1e-6);
  return 0;
}

void add_report(CLI::App& app, ReportArgs& args, int& exit_code) {
  auto* command = app.add_subcommand(
      "report", "one HTML page of a sweep's results, or of files of `run --json`: plots, tables, filters; no network");
  command
      ->add_option("folder", args.folder,
                   "of `ctusim sweep`, or with files of `ctusim run --json`; ladder.json of "
                   "`ctusim ladder` is shown as well")
      ->required();
  command->add_option("-o,--output", args.output, "page to write; without it report.html in the folder");
  command->add_option("--title", args.title, "of the page; without it the folder's name");
  command->add_option("--libraries", args.libraries,
                      "folder where `npm ci` has put what draws the page; without it report/ of the source tree");
  command->add_flag("--plain", args.plain, "tables as CSV and a script for gnuplot instead of a page");
  command->callback([&] { exit_code = report_command(args); });
}

}  // namespace ctu::report
