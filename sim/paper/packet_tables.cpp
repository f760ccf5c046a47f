#include "sim/paper/packet_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "model/numeric/interval.h"
#include "sim/paper/markdown_table.h"

namespace ctu::sim::paper {
namespace {

using cull::packet::kMethods;

double ratio(double part, double whole) { return whole == 0 ? 0 : part / whole; }
double ratio(std::uint64_t part, std::uint64_t whole) {
  return ratio(static_cast<double>(part), static_cast<double>(whole));
}
std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

Cells with_methods(Cells titles) {
  for (const auto method : kMethods) titles.emplace_back(to_string(method));
  return titles;
}

/// Of all scenes, by kind of rays, in the order in which the kinds come.
std::vector<std::pair<std::string, PacketResult>> by_kind(const std::vector<PacketRow>& rows) {
  std::vector<std::pair<std::string, PacketResult>> sums;
  for (const PacketRow& row : rows) {
    auto at = std::find_if(sums.begin(), sums.end(), [&](const auto& sum) { return sum.first == row.rays; });
    if (at == sums.end()) at = sums.insert(at, {row.rays, {}});
    at->second += row.result;
  }
  return sums;
}

void add_findings(MarkdownTable& table, Cells cells, const PacketFindings& findings) {
  cells.push_back(fmt::format("{}", findings.questions));
  cells.push_back(percent(ratio(findings.all_miss, findings.questions)));
  for (const std::uint64_t found : findings.found) cells.push_back(percent(ratio(found, findings.all_miss)));
  cells.push_back(percent(ratio(findings.found_by_some, findings.all_miss)));
  cells.push_back(fmt::format("{}", findings.lost));
  table.add(cells);
}

std::string findings_table(const std::vector<PacketRow>& rows, PacketFindings PacketResult::*findings) {
  Cells titles = with_methods({"scene", "rays", "questions", "exactly all-miss"});
  titles.insert(titles.end(), {"any of them", "lost"});
  MarkdownTable table(titles, 2);
  for (const PacketRow& row : rows)
    if ((row.result.*findings).questions > 0) add_findings(table, {row.scene, row.rays}, row.result.*findings);
  for (const auto& [kind, sum] : by_kind(rows)) add_findings(table, {"*all scenes*", kind}, sum.*findings);
  return table.text();
}

void add_work(MarkdownTable& table, Cells cells, const PacketResult& result) {
  cells.push_back(fmt::format("{}", result.rays));
  std::uint64_t lost = 0, near = 0, ties = 0;
  for (const PacketWork& work : result.work) {
    const PacketShares shares = shares_of(work.counts);
    cells.push_back(
        fmt::format("{:.1f} / {:.1f} %", 100 * shares.ray_tests, 100 * (shares.ray_tests + shares.packet_tests)));
    lost += work.lost_hits, near += work.near_misses, ties += work.ties;
  }
  const reference::PacketCounts& counts = result.work[1].counts;
  cells.push_back(percent(ratio(counts.tests(), result.single.intersections())));
  cells.push_back(percent(ratio(counts.alone_node_tests + counts.alone_primitive_tests, counts.tests())));
  cells.push_back(fmt::format("{} / {} / {}", lost, near, ties));
  table.add(cells);
}

std::string work_table(const std::vector<PacketRow>& rows) {
  Cells titles = with_methods({"scene", "rays", "number"});
  titles.insert(titles.end(), {"tests of four boxes at once", "of them by rays alone", "lost / near misses / ties"});
  MarkdownTable table(titles, 2);
  for (const PacketRow& row : rows) add_work(table, {row.scene, row.rays}, row.result);
  for (const auto& [kind, sum] : by_kind(rows)) add_work(table, {"*all scenes*", kind}, sum);
  return table.text();
}

std::string sweep_table(const std::vector<PacketSweep>& sweeps) {
  Cells titles = {"rays", "formed by"};
  for (const int size : kSweepSizes) titles.push_back(fmt::format("{} rays", size));
  MarkdownTable table(titles, 2);
  for (const PacketSweep& sweep : sweeps)
    for (std::size_t f = 0; f < kSweepForming.size(); ++f) {
      Cells cells = {sweep.rays, std::string(to_string(kSweepForming[f]))};
      const auto scenes = static_cast<double>(sweep.scenes);
      for (const PacketSweep::Cell& cell : sweep.cells[f])
        cells.push_back(fmt::format("{:.1f} / {:.1f} %", cell.ray_tests / scenes, cell.all_tests / scenes));
      table.add(cells);
    }
  return table.text();
}

std::string operations(const numeric::OperationCounts& counts, std::uint64_t times) {
  const auto each = [&](std::uint64_t n) { return ratio(n, times); };
  return fmt::format("{:.0f} + {:.0f} + {:.1f}", each(counts.additions), each(counts.multiplications),
                     each(counts.divisions));
}

std::string cost_table(const std::vector<PacketRow>& rows) {
  MarkdownTable table(
      {"rays", "method", "boxes found", "triangles found", "to bound a packet", "for a box", "for a triangle"}, 2);
  for (const auto& [kind, sum] : by_kind(rows))
    for (std::size_t m = 0; m < kPacketMethods; ++m)
      table.add({kind, std::string(to_string(kMethods[m])), percent(ratio(sum.boxes.found[m], sum.boxes.all_miss)),
                 percent(ratio(sum.triangles.found[m], sum.triangles.all_miss)), operations(sum.building[m], sum.parts),
                 operations(sum.boxes.operations[m], sum.boxes.questions),
                 operations(sum.triangles.operations[m], sum.triangles.questions)});
  return table.text();
}

std::string bloat_table(const std::vector<PacketRow>& rows) {
  MarkdownTable table({"rays", "packets", "V.V: exactly", "intervals", "affine forms", "o x d: the rays' own width",
                       "intervals", "affine forms"},
                      1);
  for (const auto& [kind, sum] : by_kind(rows)) {
    const auto mean = [](double value, std::uint64_t packets) {
      return packets == 0 ? std::string("-") : fmt::format("{:.3f}", value / static_cast<double>(packets));
    };
    const PacketBloat& bloat = sum.bloat;
    table.add({kind, fmt::format("{}", bloat.packets), "1", mean(bloat.interval_length, bloat.packets),
               mean(bloat.affine_length, bloat.packets), "1", mean(bloat.interval_moment, bloat.wide_packets),
               mean(bloat.affine_moment, bloat.wide_packets)});
  }
  return table.text();
}

std::string interval_text(const numeric::Interval& x) { return fmt::format("[{}, {}]", x.lo, x.hi); }

/// The paper has no measurements; these are the numbers it works out.
std::string worked_table() {
  using numeric::Interval;
  const auto time = [](const Interval& box, const Interval& origin, const Interval& direction) {
    return interval_text((box - origin) * reciprocal(direction));
  };
  MarkdownTable table({"what", "paper", "ours"}, 1);
  table.add({"section 3: [1, 2] [2, 4]^-1", "[0.25, 1]", interval_text(Interval{1, 2} * reciprocal(Interval{2, 4}))});
  table.add({"section 3: the interval of 1/2 and 2/4", "a point",
             interval_text(unite(Interval::point(1) / Interval::point(2), Interval::point(2) / Interval::point(4)))});
  table.add({"section 3.1, Fig. 3: T_x", "[1.5, 6]", time({2, 3}, {-3, -1}, {1, 2})});
  table.add({"section 3.1, Fig. 3: T_y", "[-3, 1]", time({-1, 2}, {1, 2}, {1, 3})});
  return table.text();
}

}  // namespace

PacketShares shares_of(const reference::PacketCounts& counts) {
  const std::uint64_t tests = counts.box_tests + counts.primitive_tests;
  const std::uint64_t alone = tests + counts.saved_box_tests + counts.saved_primitive_tests;
  return {ratio(tests, alone), ratio(counts.questions(), alone)};
}

std::string packet_report(const std::vector<PacketRow>& rows, const std::vector<PacketSweep>& sweeps) {
  std::string text = "### The paper's worked numbers\n\n" + worked_table();
  text += "\n### Boxes: found, of what all rays miss exactly\n\n" + findings_table(rows, &PacketResult::boxes);
  text += "\n### Triangles: found, of what all rays miss exactly\n\n" + findings_table(rows, &PacketResult::triangles);
  if (std::any_of(rows.begin(), rows.end(), [](const PacketRow& row) { return row.result.spheres.questions > 0; }))
    text += "\n### Spheres: found, of what all rays miss exactly\n\n" + findings_table(rows, &PacketResult::spheres);
  text +=
      "\n### Tests of one box or primitive that are left: of single rays / with the packets' own, of those of rays "
      "alone\n\n" +
      work_table(rows);
  text += "\n### Sizes and ways to form packets (axis-interval, mean over scenes)\n\n" + sweep_table(sweeps);
  text += "\n### Tightness and cost: additions + multiplications + divisions and roots, each rounded once\n\n" +
          cost_table(rows);
  text +=
      "\n### Section 6: how large V.V may be for directions of length 1, and how wide o x d, mean over packets\n\n" +
      bloat_table(rows);
  return text;
}

}  // namespace ctu::sim::paper
