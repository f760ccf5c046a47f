#include "sim/paper/subspace_tables.h"

#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "sim/paper/markdown_table.h"

namespace ctu::sim::paper {
namespace {

using Table = MarkdownTable;

constexpr Column kRatioColumns[] = {
    Column::Ideal,          Column::Lut,        Column::LutDouble, Column::CompressedPaper, Column::CompressedSummed,
    Column::CompressedOurs, Column::Comparators};
constexpr Column kTimeColumns[] = {
    Column::Ideal,          Column::Lut,      Column::LutDouble,  Column::Unasked, Column::CompressedPaper,
    Column::CompressedOurs, Column::BitTable, Column::Comparators};

const char* title(Column column) {
  switch (column) {
    case Column::NoCulling:
      return "no culling";
    case Column::Unasked:
      return "box test of culling alone";
    case Column::Ideal:
      return "ideal";
    case Column::Lut:
      return "LUT, R_ray = R";
    case Column::LutDouble:
      return "LUT, R_ray = 2R";
    case Column::CompressedPaper:
      return "256 entries, importance per node";
    case Column::CompressedSummed:
      return "256 entries, importance summed";
    case Column::CompressedOurs:
      return "256 entries, our selection";
    case Column::BitTable:
      return "the same as bit table";
    case Column::Comparators:
      return "comparators";
  }
  return "";
}

std::string percent(double value) { return fmt::format("{:.1f} %", value); }
/// With three digits, or all before the point.
std::string milliseconds(double seconds) {
  return 1e3 * seconds < 100 ? fmt::format("{:.3g}", 1e3 * seconds) : fmt::format("{:.0f}", 1e3 * seconds);
}

/// "paper: San Miguel (same)", indented below our row.
std::string paper_row(const Counterpart& paper) {
  return fmt::format("&emsp;*paper: {} ({})*", paper.scene->name, to_string(paper.kinship));
}

double ratio(const ResolutionResult& result, Column column) {
  return result.columns[static_cast<std::size_t>(column)].percent;
}

/// The mean over scenes of each number that `numbers` gives.
Cells mean_row(const std::vector<SceneResult>& results, const std::string& title,
               const std::function<std::vector<double>(const SceneResult&)>& numbers) {
  std::vector<double> sums;
  for (const SceneResult& scene : results) {
    const std::vector<double> values = numbers(scene);
    sums.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) sums[i] += values[i] / static_cast<double>(results.size());
  }
  Cells cells{title};
  for (const double sum : sums) cells.push_back(percent(sum));
  return cells;
}

std::vector<double> ratios(const ResolutionResult& result) {
  std::vector<double> values;
  for (const Column column : kRatioColumns) values.push_back(ratio(result, column));
  return values;
}

/// What our selection loses to uncompressed masks, as a share of what the paper's loses.
std::string loss_left(const ResolutionResult& result) {
  const double lut = ratio(result, Column::Lut), paper = ratio(result, Column::CompressedPaper) - lut;
  return paper < 0.05 ? "-" : fmt::format("{:.2f}", (ratio(result, Column::CompressedOurs) - lut) / paper);
}

/// A step between two columns of Table 1 in points, ours and the paper's.
struct StepPair {
  double ours, paper;
  bool agrees() const { return std::fabs(ours - paper) <= kAgreementPoints; }
};

std::vector<StepPair> steps(const ResolutionResult& ours, const PublishedRatios& paper) {
  const double ideal = ratio(ours, Column::Ideal), lut = ratio(ours, Column::Lut);
  const double compressed = paper.compressed - paper.lut;
  return {{ideal - 100, paper.ideal - 100},
          {lut - ideal, paper.lut - paper.ideal},
          {ratio(ours, Column::LutDouble) - lut, paper.lut_double - paper.lut},
          {ratio(ours, Column::CompressedPaper) - lut, compressed},
          {ratio(ours, Column::CompressedSummed) - lut, compressed}};
}

std::string step_cell(const StepPair& step) {
  const std::string text = fmt::format("{:+.1f} / {:+.1f}", step.ours, step.paper);
  return step.agrees() ? text : "**" + text + "**";
}

std::string level_name(int levels) {
  return levels == cull::kUnlimitedLevels ? "unlimited" : fmt::format("L = {}", levels);
}

}  // namespace

std::string scene_table(const std::vector<SceneResult>& results) {
  Table table({"scene", "held against", "kinship", "what differs", "triangles", "4-wide nodes", "rays",
               "intersections/ray", "lost hits", "near misses", "ties"},
              4);
  for (const SceneResult& scene : results) {
    const Counterpart paper = counterpart(scene.name);
    const ResolutionResult& first = scene.at.front();
    std::uint64_t lost = 0, near = 0, ties = 0;
    for (const ResolutionResult& result : scene.at) {
      lost += result.lost_hits;
      near += result.near_misses;
      ties += result.ties;
    }
    table.add({scene.name, paper.scene == nullptr ? "-" : paper.scene->name, to_string(paper.kinship), paper.remark,
               fmt::format("{}", scene.triangles), fmt::format("{}", scene.nodes), fmt::format("{}", first.rays),
               fmt::format("{:.2f}", first.intersections_per_ray), fmt::format("{}", lost), fmt::format("{}", near),
               fmt::format("{}", ties)});
  }
  return table.text();
}

std::string ratio_table(const std::vector<SceneResult>& results, std::size_t r) {
  Cells titles{"scene"};
  for (const Column column : kRatioColumns) titles.emplace_back(title(column));
  titles.emplace_back("our loss / loss per node");
  Table table(titles, 1);
  for (const SceneResult& scene : results) {
    Cells cells{scene.name};
    for (const double value : ratios(scene.at[r])) cells.push_back(percent(value));
    cells.push_back(loss_left(scene.at[r]));
    table.add(cells);
    const Counterpart paper = counterpart(scene.name);
    if (paper.scene == nullptr) continue;
    const PublishedRatios& row = paper.scene->ratios[r];
    table.add({paper_row(paper), percent(row.ideal), percent(row.lut), percent(row.lut_double), percent(row.compressed),
               "", "", "", ""});
  }
  if (!results.empty()) {
    Cells mean = mean_row(results, "*mean of ours*", [&](const SceneResult& scene) { return ratios(scene.at[r]); });
    mean.push_back("");
    table.add(mean);
  }
  return table.text();
}

std::string step_table(const std::vector<SceneResult>& results) {
  Table table({"scene", "paper's", "R", "no culling to ideal", "ideal to R_ray = R", "R_ray = R to 2R",
               "R_ray = R to 256 entries, importance per node", "... summed over equal masks"},
              2);
  std::vector<int> agreeing;
  int all = 0;
  for (const SceneResult& scene : results) {
    const Counterpart paper = counterpart(scene.name);
    if (paper.scene == nullptr) continue;
    for (std::size_t r = 0; r < kResolutions.size(); ++r) {
      Cells cells{scene.name, fmt::format("{} ({})", paper.scene->name, to_string(paper.kinship)),
                  fmt::format("{}", kResolutions[r])};
      const std::vector<StepPair> pairs = steps(scene.at[r], paper.scene->ratios[r]);
      agreeing.resize(pairs.size());
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        cells.push_back(step_cell(pairs[i]));
        agreeing[i] += pairs[i].agrees();
      }
      ++all;
      table.add(cells);
    }
  }
  Cells sum{fmt::format("*within {:.0f} points*", kAgreementPoints), "", ""};
  for (const int count : agreeing) sum.push_back(fmt::format("{} of {}", count, all));
  if (all > 0) table.add(sum);
  return table.text() + "\nThe steps in bold are further apart.\n";
}

std::string time_table(const std::vector<SceneResult>& results, std::size_t r) {
  Cells titles{"scene", "no culling"};
  for (const Column column : kTimeColumns) titles.emplace_back(title(column));
  Table table(titles, 1);
  const auto relative = [&](const SceneResult& scene) {
    std::vector<double> values;
    for (const Column column : kTimeColumns)
      values.push_back(100 * scene.at[r].columns[static_cast<std::size_t>(column)].relative_seconds);
    return values;
  };
  for (const SceneResult& scene : results) {
    const ResolutionResult& result = scene.at[r];
    const double base = result.columns.front().seconds;
    const double per_ray = result.timed_rays == 0 ? 0 : 1e6 * base / static_cast<double>(result.timed_rays);
    Cells cells{scene.name, fmt::format("{:.2f} s, {:.2f} us/ray", base, per_ray)};
    for (const double value : relative(scene)) cells.push_back(percent(value));
    table.add(cells);
    const Counterpart paper = counterpart(scene.name);
    if (paper.scene == nullptr) continue;
    const PublishedTimes& row = paper.scene->times[r];
    table.add({paper_row(paper), fmt::format("{:.2f} s", paper.scene->seconds), percent(row.ideal), percent(row.lut),
               percent(row.lut_double), "", "", "", "", ""});
  }
  if (!results.empty()) {
    Cells mean = mean_row(results, "*mean of ours*", relative);
    mean.insert(mean.begin() + 1, "");
    table.add(mean);
  }
  return table.text();
}

std::string table_making_table(const std::vector<const RayTables*>& tables) {
  Table table({"R", "R_ray", "ours, ms", "paper, ms", "table, KiB"}, 0);
  for (std::size_t r = 0; r < tables.size(); ++r) {
    const RayTables& made = *tables[r];
    const auto add = [&](int ray_resolution, double seconds, double paper, std::uint64_t bytes) {
      table.add({fmt::format("{}", made.resolution()), fmt::format("{}", ray_resolution), milliseconds(seconds),
                 fmt::format("{:.1f}", paper), fmt::format("{}", bytes / 1024)});
    };
    add(made.resolution(), made.lut_seconds(), kPublishedTableTimes[r].lut, made.lut_bytes());
    add(2 * made.resolution(), made.lut_double_seconds(), kPublishedTableTimes[r].lut_double, made.lut_double_bytes());
  }
  return table.text();
}

std::string search_table(const std::vector<SceneResult>& results) {
  Table table(
      {"scene", "R", "masks", "brute force, ms", "requirement LUTs, ms", "relative", "making the requirement LUTs, ms"},
      1);
  for (const SceneResult& scene : results)
    for (std::size_t r = 0; r < kResolutions.size(); ++r) {
      const SearchResult& search = scene.at[r].search;
      const auto relative = [](double ours, double naive) {
        return naive > 0 ? percent(100 * ours / naive) : std::string("-");
      };
      table.add({scene.name, fmt::format("{}", kResolutions[r]), fmt::format("{}", search.masks),
                 milliseconds(search.naive_seconds), milliseconds(search.ours_seconds),
                 relative(search.ours_seconds, search.naive_seconds), milliseconds(search.table_seconds)});
      const Counterpart paper = counterpart(scene.name);
      if (paper.scene == nullptr) continue;
      const PublishedSearch& row = paper.scene->search[r];
      table.add({paper_row(paper), fmt::format("{}", kResolutions[r]), "", fmt::format("{:.1f}", row.naive),
                 fmt::format("{:.1f}", row.ours), relative(row.ours, row.naive), ""});
    }
  return table.text();
}

std::string level_table(const std::vector<SceneResult>& results, std::size_t r) {
  if (results.empty()) return {};
  Cells titles{"scene"};
  for (const LevelResult& level : results.front().at[r].levels) titles.push_back(level_name(level.levels));
  titles.push_back("L = 1, ms");
  Table table(titles, 1);
  for (const SceneResult& scene : results) {
    const std::vector<LevelResult>& levels = scene.at[r].levels;
    const double base = levels.front().seconds;
    Cells cells{scene.name};
    for (const LevelResult& level : levels)
      cells.push_back(fmt::format("{:.1f} %, {:.2f}x", level.percent, base > 0 ? level.seconds / base : 0));
    cells.push_back(milliseconds(base));
    table.add(cells);
  }
  return table.text();
}

std::string report(const std::vector<SceneResult>& results, const std::vector<const RayTables*>& tables) {
  std::string text = "### Scenes\n\n" + scene_table(results);
  const auto per_resolution = [&](const char* title, auto&& table) {
    for (std::size_t r = 0; r < kResolutions.size(); ++r)
      text += fmt::format("\n### {}, R = {}\n\n", title, kResolutions[r]) + table(results, r);
  };
  per_resolution("Table 1: intersections relative to no culling", ratio_table);
  text += "\n### Steps between Table 1's columns, in points: ours / the paper's\n\n" + step_table(results);
  per_resolution("Table 2: time relative to no culling", time_table);
  text += "\n### Section 4.2: making the ray mask tables\n\n" + table_making_table(tables);
  text += "\n### Table 3: finding the tightest of 256 entries for every mask\n\n" + search_table(results);
  per_resolution(
      "Fig. 8: object masks from L levels below: intersections relative to no culling, time to make the "
      "masks relative to L = 1",
      level_table);
  return text;
}

}  // namespace ctu::sim::paper
