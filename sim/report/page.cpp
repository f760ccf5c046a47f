#include "sim/report/page.h"

#include <algorithm>
#include <charconv>
#include <set>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "model/base/version.h"
#include "sim/report/encoding.h"

namespace ctu::report {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kScripts[] = {"vega/build/vega.min.js", "vega-lite/build/vega-lite.min.js",
                                    "vega-embed/build/vega-embed.min.js"};

std::string read(const fs::path& file) {
  constexpr std::uint64_t kMostBytes = 64 << 20;
  return read_file(file, kMostBytes, "run `npm ci` in the folder report/, or give --plain");
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// Inside <script>: the end of the element is written otherwise, with the same meaning in JavaScript.
std::string as_script(std::string text) {
  replace_all(text, "</script", "<\\/script");
  replace_all(text, "<!--", "<\\!--");
  return "<script>\n" + text + "\n</script>\n";
}

std::string as_data(const std::string& id, const ordered_json& data) {
  std::string text = data.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  replace_all(text, "<", "\\u003c");
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, text);
}

/// Six digits are more than any plot shows.
ordered_json rounded(const ordered_json& value) {
  if (!value.is_number_float()) return value;
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value.get<double>(), std::chars_format::general, 6).ptr;
  return ordered_json::parse(text, end);
}

/// Columns once, then a list for each row.
ordered_json rows_data(const Results& results) {
  const std::vector<std::string> names = page_columns(results);
  ordered_json columns = ordered_json::array(), rows = ordered_json::array();
  for (const std::string& name : names) {
    const Column& column = *results.find(name);
    columns.push_back({{"name", name},
                       {"field", field_of(name)},
                       {"title", title_of(results, name)},
                       {"unit", column.unit},
                       {"meaning", column.meaning}});
  }
  for (const ordered_json& row : results.rows) {
    ordered_json list = ordered_json::array();
    for (const std::string& name : names) list.push_back(row.contains(name) ? rounded(row[name]) : ordered_json());
    rows.push_back(std::move(list));
  }
  return {{"columns", columns}, {"rows", rows}};
}

ordered_json charts_data(const std::vector<Chart>& charts) {
  ordered_json list = ordered_json::array();
  for (const Chart& chart : charts) {
    ordered_json columns = ordered_json::array();
    for (const std::string& column : chart.columns) columns.push_back(field_of(column));
    list.push_back({{"id", chart.id},
                    {"renderer", chart.renderer},
                    {"columns", columns},
                    {"rows", chart.rows},
                    {"spec", chart.spec}});
  }
  return list;
}

/// What rows can be chosen by: few values each.
ordered_json filters_data(const Results& results) {
  constexpr std::size_t kMostValues = 12;
  std::vector<std::string> columns = {"scene", "design", "engine"};
  for (const std::string& moved : moved_columns(results))
    if (moved != "config.mask_test.design") columns.push_back(moved);
  ordered_json filters = ordered_json::array();
  for (const std::string& column : columns) {
    const auto values = values_of(results, column);
    if (values.size() < 2 || values.size() > kMostValues) continue;
    filters.push_back({{"field", field_of(column)}, {"title", title_of(results, column)}, {"values", values}});
  }
  return filters;
}

std::string figure(const Chart& chart) {
  return fmt::format(
      "<figure id=\"{0}\">\n<h2>{1}</h2>\n<div class=\"plot\"></div>\n<figcaption>{2}</figcaption>\n"
      "<details class=\"table\"><summary>Table</summary><div class=\"cells\"></div></details>\n</figure>\n",
      chart.id, escaped(chart.title), escaped(chart.caption));
}

/// Licences of everything that is in the scripts, each text once.
std::string licences(const fs::path& modules) {
  std::vector<fs::path> packages;
  for (const auto& entry : fs::directory_iterator(modules))
    if (entry.is_directory() && entry.path().filename() != "playwright-core") packages.push_back(entry.path());
  std::sort(packages.begin(), packages.end());
  std::string text;
  std::set<std::string> told;
  for (const fs::path& package : packages)
    for (const auto& entry : fs::directory_iterator(package)) {
      if (!entry.is_regular_file() || !entry.path().filename().string().starts_with("LICENSE")) continue;
      const std::string licence = read(entry.path());
      text += told.insert(licence).second
                  ? fmt::format("<h3>{}</h3><pre>{}</pre>\n", escaped(package.filename().string()), escaped(licence))
                  : fmt::format("<h3>{}</h3><p>As one above.</p>\n", escaped(package.filename().string()));
    }
  return text;
}

std::string summary(const Results& results) {
  std::string text =
      fmt::format("{} runs, {} scenes, {} designs, made by ctusim {}", results.rows.size(),
                  values_of(results, "scene").size(), values_of(results, "design").size(), tool_version());
  const auto wrong = std::count_if(results.rows.begin(), results.rows.end(),
                                   [](const ordered_json& row) { return row.value("wrong_hits", 0) != 0; });
  if (wrong != 0) text += fmt::format("; {} of them with wrong hits", wrong);
  if (results.failed != 0)
    text += fmt::format("; {} more ended without a result (ctusim sweep status says why)", results.failed);
  return text + ".";
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string html = text;
  replace_all(html, "&", "&amp;");
  replace_all(html, "<", "&lt;");
  replace_all(html, ">", "&gt;");
  replace_all(html, "\"", "&quot;");
  return html;
}

bool has_libraries(const fs::path& folder) {
  return std::all_of(std::begin(kScripts), std::end(kScripts),
                     [&](const char* script) { return fs::exists(folder / "node_modules" / script); });
}

std::string make_page(const Results& results, const std::vector<Chart>& charts, const std::string& title,
                      const fs::path& folder) {
  std::string figures, scripts;
  for (const Chart& chart : charts) figures += figure(chart);
  scripts += as_data("rows-data", rows_data(results));
  scripts += as_data("charts-data", charts_data(charts));
  scripts += as_data("filters-data", filters_data(results));
  for (const char* script : kScripts) scripts += as_script(read(folder / "node_modules" / script));
  scripts += as_script(read(folder / "page.js"));

  std::string page = read(folder / "page.html");
  // What is put in is not looked through again: data may hold anything.
  const std::pair<const char*, std::string> parts[] = {{"{{title}}", escaped(title)},
                                                       {"{{summary}}", escaped(summary(results))},
                                                       {"{{style}}", read(folder / "page.css")},
                                                       {"{{figures}}", figures},
                                                       {"{{licences}}", licences(folder / "node_modules")},
                                                       {"{{scripts}}", scripts}};
  std::string out;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t mark = page.find("{{", at);
    out += page.substr(at, mark - at);
    if (mark == std::string::npos) break;
    const std::size_t end = page.find("}}", mark) + 2;
    for (const auto& [name, text] : parts)
      if (page.compare(mark, end - mark, name) == 0) out += text;
    at = end;
  }
  return out;
}

}  // namespace ctu::report
