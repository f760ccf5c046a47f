#include "sim/report/plain_files.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "sim/paper/plot.h"
#include "sim/report/chart.h"
#include "sim/report/encoding.h"

namespace ctu::report {
namespace {

using nlohmann::ordered_json;

std::string cell(const ordered_json& row, const std::string& column) {
  const auto value = row.find(column);
  if (value == row.end() || value->is_null()) return "";
  if (!value->is_string()) return value->dump();
  std::string text = "\"";
  for (const char c : value->get<std::string>()) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

std::string csv_of(const Results& results) {
  const std::vector<std::string> columns = page_columns(results);
  std::string text;
  for (const std::string& column : columns) {
    if (!text.empty()) text += ',';
    text += column;
  }
  text += '\n';
  for (const ordered_json& row : results.rows) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i != 0) text += ',';
      text += cell(row, columns[i]);
    }
    text += '\n';
  }
  return text;
}

/// Blocks of x and y, one for each scene and design, as gnuplot's `index` takes them by name. `fewest`: only the least
/// y at each x.
std::string blocks_of(const Results& results, const std::string& x, const std::string& y, bool fewest) {
  std::map<std::string, std::multimap<double, double>> series;
  for (const ordered_json& row : results.rows) {
    const auto a = row.find(x), b = row.find(y);
    if (a == row.end() || b == row.end() || !a->is_number() || !b->is_number()) continue;
    auto& points = series[row.value("scene", "") + ", " + row.value("design", "")];
    const auto known = points.find(a->get<double>());
    if (fewest && known != points.end())
      known->second = std::min(known->second, b->get<double>());
    else
      points.emplace(a->get<double>(), b->get<double>());
  }
  std::string text;
  for (const auto& [name, points] : series) {
    text += fmt::format("\"{}\"\n", name);
    for (const auto& [a, b] : points) text += fmt::format("{} {}\n", a, b);
    text += "\n\n";
  }
  return text;
}

std::string plot_of(const Results& results, const std::string& name, const std::string& x, const std::string& y,
                    const char* with) {
  return fmt::format(
      "set xlabel \"{}\" noenhanced\nset ylabel \"{}\" noenhanced\nset title \"{} against {}\" noenhanced\n"
      "stats \"{}\" using 1 nooutput\nplot for [i=0:STATS_blocks-2] \"{}\" index i using 1:2 with {} title "
      "columnheader(1) "
      "noenhanced\n",
      title_of(results, x), title_of(results, y), title_of(results, y), title_of(results, x), name, name, with);
}

}  // namespace

void write_plain_files(const Results& results, const std::filesystem::path& folder) {
  using sim::paper::write_file;
  write_file(folder, "report.csv", csv_of(results));
  std::string script =
      "set terminal svg size 900,1200 background \"white\"\nset output \"report.svg\"\nset key outside bottom\n"
      "set logscale xy\nset grid\nset multiplot layout 2,1\n";
  const std::string bits = has_numbers(results, "on_chip_bits") ? "on_chip_bits" : "mask_test.on_chip_bits";
  int plots = 0;
  const auto add = [&](const std::string& name, const std::string& x, const char* with, bool fewest) {
    if (!has_numbers(results, x) || !has_numbers(results, "cycles_per_ray")) return;
    write_file(folder, name, blocks_of(results, x, "cycles_per_ray", fewest));
    script += plot_of(results, name, x, "cycles_per_ray", with);
    ++plots;
  };
  add("report-bits.dat", bits, "points pointsize 0.5", false);
  add("report-tables.dat", "mask_test.table_bits", "linespoints", true);
  if (plots == 0) return;
  write_file(folder, "report.gp", script + "unset multiplot\n");
  if (sim::paper::have_gnuplot()) sim::paper::run_gnuplot(folder, "report.gp");
}

}  // namespace ctu::report
