#include "sim/metamorph/report.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace ctu::sim::metamorph {
namespace {

const char* to_string(Same same) { return same == Same::Yes ? "yes" : same == Same::No ? "NO" : "-"; }

/// Rows of one kind as one; the rays as it is and reversed are kinds of their own.
std::vector<CheckRow> by_kind(const std::vector<CheckRow>& rows) {
  std::vector<CheckRow> sums;
  for (const CheckRow& row : rows) {
    if (sums.empty() || row.kind == Kind::Identity || sums.back().kind != row.kind) {
      sums.push_back(row);
      continue;
    }
    CheckRow& sum = sums.back();
    sum.name += "; " + row.name;
    sum.rays += row.rays;
    sum.changed += row.changed;
    sum.declined += row.declined, sum.not_compared += row.not_compared;
    sum.same = std::max(sum.same, row.same);
  }
  return sums;
}

}  // namespace

void print_header() {
  fmt::print("{:<20} {:<22}{:>9}{:>9}{:>7}{:>7}{:>9}{:>10}{:>11}\n", "scene", "transformation", "rays", "changed",
             "lost", "near", "ties", "same bits", "of rays");
}

void print_scene(const NamedReport& named) {
  for (const CheckRow& row : named.report.rows) {
    const bool promised = row.same != Same::NotPromised;
    fmt::print("{:<20} {:<22}{:>9}{:>9}{:>7}{:>7}{:>9}{:>10}{:>11}\n", named.scene, row.name, row.rays,
               row.changed.all(), row.changed.lost, row.changed.near_misses, row.changed.ties, to_string(row.same),
               promised ? fmt::format("{}", row.rays - row.not_compared) : "-");
    if (row.declined != 0)
      fmt::print("{:<20} {:<22} {} triangles exactly met and declined by the triangle test\n", "", "", row.declined);
  }
  const EdgeRow& e = named.report.edges;
  if (named.report.edges_checked)
    fmt::print(
        "{:<20} {} closed parts of {} triangles: {} rays at {} edges and {} vertices, leaks {}, declined {}, passed by "
        "{}\n",
        named.scene, e.parts, e.triangles, e.rays, e.edges, e.vertices, e.found.leaks, e.found.declined,
        e.found.passed_by);
  std::fflush(stdout);
}

void print_markdown(const std::vector<NamedReport>& reports) {
  fmt::print(
      "| scene | transformations | rays | changed hits | lost | near misses | ties | same bits | of rays |\n"
      "| --- | --- | ---: | ---: | ---: | ---: | ---: | --- | ---: |\n");
  for (const auto& [scene, report] : reports)
    for (const CheckRow& row : by_kind(report.rows))
      fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", scene, row.name, row.rays, row.changed.all(),
                 row.changed.lost, row.changed.near_misses, row.changed.ties, to_string(row.same),
                 row.same == Same::NotPromised ? "-" : fmt::format("{}", row.rays - row.not_compared));
  fmt::print(
      "\n| scene | closed parts | triangles | edges | vertices | folds | rays | passed by | declined | leaks |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (const auto& [scene, report] : reports) {
    const EdgeRow& e = report.edges;
    if (e.parts != 0)
      fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", scene, e.parts, e.triangles, e.edges,
                 e.vertices, e.folds, e.rays, e.found.passed_by, e.found.declined, e.found.leaks);
  }
}

void print_remarks(const NamedReport& named) {
  for (const std::string& what : named.report.left_out) fmt::print(stderr, "{}: left out: {}\n", named.scene, what);
  for (const std::string& what : named.report.defects) fmt::print(stderr, "{}: {}\n", named.scene, what);
}

}  // namespace ctu::sim::metamorph
