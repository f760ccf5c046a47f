#include "sim/paper/raybox_tables.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "sim/paper/markdown_table.h"

namespace ctu::sim::paper {
namespace {

std::string pair(double ours, double paper) { return fmt::format("{:.2f} / {:.2f}", ours, paper); }
std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }
std::string percents(double ours, double paper) { return fmt::format("{:.1f} % / {:.1f} %", 100 * ours, 100 * paper); }

double per_ray(std::uint64_t count, const RayboxResult& scene) {
  return static_cast<double>(count) / static_cast<double>(std::max<std::uint64_t>(scene.rays, 1));
}

double removed(std::uint64_t culled, std::uint64_t plain) {
  return plain == 0 ? 0 : 1 - static_cast<double>(culled) / static_cast<double>(plain);
}

double kilobytes(double bytes) { return bytes / 1024; }

std::string scene_table(const std::vector<RayboxRow>& rows) {
  MarkdownTable table({"scene", "the paper's", "what differs", "triangles", "spheres", "paper's primitives",
                       "kd levels", "paper", "rays", "shadow rays", "lost hits", "near misses", "ties"},
                      3);
  for (const RayboxRow& row : rows) {
    const RayboxResult& s = row.ours;
    table.add({s.name, row.paper->name, row.remark, fmt::format("{}", s.triangles), fmt::format("{}", s.spheres),
               fmt::format("{}", row.paper->primitives), fmt::format("{}", s.max_depth),
               fmt::format("{}", row.paper->depth), fmt::format("{}", s.rays), fmt::format("{}", s.shadow_rays),
               fmt::format("{}", s.changed.lost), fmt::format("{}", s.changed.near_misses),
               fmt::format("{}", s.changed.ties)});
  }
  return table.text();
}

/// Calls `add(row, i)` for every scene and leaf size.
void for_each_size(const std::vector<RayboxRow>& rows, const std::function<void(const RayboxRow&, std::size_t)>& add) {
  for (const RayboxRow& row : rows)
    for (std::size_t i = 0; i < row.ours.kd.size(); ++i) add(row, i);
}

std::string leaf_cell(const RayboxRow& row, std::size_t i) { return fmt::format("{}", row.ours.kd[i].leaf_size); }

std::string culling_table(const std::vector<RayboxRow>& rows) {
  MarkdownTable table({"scene", "leaf size", "N_T", "N_PI without", "N_PI with", "removed", "N_AC", "N_AU", "T_B, s",
                       "T_R with / without"},
                      1);
  for_each_size(rows, [&](const RayboxRow& row, std::size_t i) {
    const KdResult& ours = row.ours.kd[i];
    const PublishedCulling& paper = row.paper->culling[i];
    const auto both = [&](std::uint64_t count, double published) { return pair(per_ray(count, row.ours), published); };
    table.add(
        {row.ours.name, leaf_cell(row, i), both(ours.plain.traversals(), paper.traversals),
         both(ours.plain.leaves.primitive_tests, paper.tests),
         both(ours.culled.leaves.primitive_tests, paper.culled_tests),
         percents(removed(ours.culled.leaves.primitive_tests, ours.plain.leaves.primitive_tests),
                  1 - paper.culled_tests / paper.tests),
         both(ours.culled.leaves.created, paper.created), both(ours.culled.leaves.updated, paper.updated),
         fmt::format("{:.3f} / {:.3f}", ours.build_seconds, paper.build_seconds),
         percents(ours.culled_seconds / std::max(ours.plain_seconds, 1e-9), paper.culled_seconds / paper.seconds)});
  });
  return table.text();
}

std::string memory_table(const std::vector<RayboxRow>& rows) {
  MarkdownTable table({"scene", "leaf size", "nodes", "paper", "references", "paper", "empty leaves", "longest leaf",
                       "tree, KB", "paper", "boxes, KB", "paper", "both, KB", "paper"},
                      1);
  for_each_size(rows, [&](const RayboxRow& row, std::size_t i) {
    const accel::KdStatistics& tree = row.ours.kd[i].tree;
    const PublishedTree& paper = row.paper->trees[i];
    const auto ours_kb = [](std::uint64_t bytes) {
      return fmt::format("{:.0f}", kilobytes(static_cast<double>(bytes)));
    };
    const double paper_tree = kilobytes(8 * paper.nodes + 4 * paper.references);
    table.add({row.ours.name, leaf_cell(row, i), fmt::format("{}", tree.nodes), fmt::format("{:.0f}", paper.nodes),
               fmt::format("{}", tree.references), fmt::format("{:.0f}", paper.references),
               fmt::format("{}", tree.empty_leaves), fmt::format("{}", tree.longest_leaf), ours_kb(tree.tree_bytes()),
               fmt::format("{:.0f}", paper_tree), ours_kb(tree.box_bytes),
               fmt::format("{:.0f}", row.paper->box_kilobytes), ours_kb(tree.tree_bytes() + tree.box_bytes),
               fmt::format("{:.0f}", paper_tree + row.paper->box_kilobytes)});
  });
  return table.text();
}

/// The least over leaf sizes of a time with culling, relative to the least without.
std::string peak(const RayboxRow& row, const std::function<double(const KdResult&, bool)>& ours,
                 const std::function<double(const PublishedCulling&, bool)>& paper) {
  const auto least = [](const auto& list, const auto& time, bool culled) {
    double best = time(list.front(), culled);
    for (const auto& one : list) best = std::min(best, time(one, culled));
    return best;
  };
  return percents(least(row.ours.kd, ours, false) / least(row.ours.kd, ours, true),
                  least(row.paper->culling, paper, false) / least(row.paper->culling, paper, true));
}

/// Fig. 7: leaves of 1 without culling against leaves of 16 with it and the boxes.
std::string footprint(const RayboxRow& row) {
  constexpr std::size_t kPlain = 0, kCulled = 3;
  static_assert(kLeafSizes[kPlain] == 1 && kLeafSizes[kCulled] == 16);
  const auto paper_bytes = [&](std::size_t i) {
    return 8 * row.paper->trees[i].nodes + 4 * row.paper->trees[i].references;
  };
  const accel::KdStatistics &plain = row.ours.kd[kPlain].tree, &culled = row.ours.kd[kCulled].tree;
  return percents(static_cast<double>(culled.tree_bytes() + culled.box_bytes) / static_cast<double>(plain.tree_bytes()),
                  (paper_bytes(kCulled) + 1024 * row.paper->box_kilobytes) / paper_bytes(kPlain));
}

std::string summary_table(const std::vector<RayboxRow>& rows) {
  MarkdownTable table({"scene", "Fig. 4: peak speed, rays", "... with building", "Fig. 6: removed, least", "... most",
                       "Fig. 7: memory"},
                      1);
  for (const RayboxRow& row : rows) {
    const auto trace_time = [](const KdResult& k, bool culled) { return culled ? k.culled_seconds : k.plain_seconds; };
    const auto paper_trace = [](const PublishedCulling& k, bool culled) {
      return culled ? k.culled_seconds : k.seconds;
    };
    const auto ours_removed = [](const KdResult& k) {
      return removed(k.culled.leaves.primitive_tests, k.plain.leaves.primitive_tests);
    };
    const auto paper_removed = [](const PublishedCulling& k) { return 1 - k.culled_tests / k.tests; };
    std::vector<double> ours, paper;
    for (const KdResult& k : row.ours.kd) ours.push_back(ours_removed(k));
    for (const PublishedCulling& k : row.paper->culling) paper.push_back(paper_removed(k));
    table.add({row.ours.name, peak(row, trace_time, paper_trace),
               peak(
                   row, [&](const KdResult& k, bool culled) { return k.build_seconds + trace_time(k, culled); },
                   [&](const PublishedCulling& k, bool culled) { return k.build_seconds + paper_trace(k, culled); }),
               percents(*std::min_element(ours.begin(), ours.end()), *std::min_element(paper.begin(), paper.end())),
               percents(*std::max_element(ours.begin(), ours.end()), *std::max_element(paper.begin(), paper.end())),
               footprint(row)});
  }
  return table.text();
}

/// Fig. 5: times relative to leaves of one primitive.
std::string time_table(const std::vector<RayboxRow>& rows) {
  MarkdownTable table({"scene", "leaf size", "building", "rays without culling", "rays with culling"}, 1);
  for_each_size(rows, [&](const RayboxRow& row, std::size_t i) {
    const KdResult &ours = row.ours.kd[i], &first = row.ours.kd[0];
    const PublishedCulling &paper = row.paper->culling[i], &paper_first = row.paper->culling[0];
    table.add({row.ours.name, leaf_cell(row, i),
               percents(ours.build_seconds / std::max(first.build_seconds, 1e-9),
                        paper.build_seconds / paper_first.build_seconds),
               percents(ours.plain_seconds / std::max(first.plain_seconds, 1e-9), paper.seconds / paper_first.seconds),
               percents(ours.culled_seconds / std::max(first.culled_seconds, 1e-9),
                        paper.culled_seconds / paper_first.culled_seconds)});
  });
  return table.text();
}

std::string clipping_table(const std::vector<RayboxRow>& rows) {
  MarkdownTable table({"scene", "leaf size", "references", "N_T", "N_PI without", "N_PI with", "removed", "boxes, KB",
                       "building, of without clipping"},
                      1);
  for_each_size(rows, [&](const RayboxRow& row, std::size_t i) {
    const KdResult& k = row.ours.kd[i];
    const auto number = [&](std::uint64_t count) { return fmt::format("{:.2f}", per_ray(count, row.ours)); };
    table.add({row.ours.name, leaf_cell(row, i), fmt::format("{}", k.clipped_tree.references),
               number(k.clipped.traversals()), number(k.clipped.leaves.primitive_tests),
               number(k.clipped_culled.leaves.primitive_tests),
               percent(removed(k.clipped_culled.leaves.primitive_tests, k.clipped.leaves.primitive_tests)),
               fmt::format("{:.0f}", kilobytes(static_cast<double>(k.clipped_tree.box_bytes))),
               percent(k.clipped_build_seconds / std::max(k.build_seconds, 1e-9))});
  });
  return table.text();
}

std::string wide_table(const std::vector<RayboxRow>& rows) {
  MarkdownTable table({"scene", "leaf size", "triangle cost", "nodes/ray", "leaves/ray", "N_PI without", "N_PI with",
                       "removed", "box tests/ray", "N_AC", "N_AU"},
                      1);
  for (const RayboxRow& row : rows)
    for (const WideResult& w : row.ours.wide) {
      const auto number = [&](std::uint64_t count) { return fmt::format("{:.2f}", per_ray(count, row.ours)); };
      table.add({row.ours.name, fmt::format("{}", w.leaf_size), fmt::format("{}", w.triangle_cost),
                 number(w.node_visits), number(w.leaf_visits), number(w.plain_tests), number(w.culled.primitive_tests),
                 percent(removed(w.culled.primitive_tests, w.plain_tests)), number(w.culled.box_tests),
                 number(w.culled.created), number(w.culled.updated)});
    }
  return table.text();
}

}  // namespace

std::string raybox_report(const std::vector<RayboxRow>& rows) {
  return "### Scenes of the ray-box paper\n\n" + scene_table(rows) +
         "\n### Table 2: work per ray in kd-trees, ours / the paper's\n\n" + culling_table(rows) +
         "\n### Table 3: memory of kd-trees\n\n" + memory_table(rows) +
         "\n### Figs. 4, 6 and 7: peak speed with culling, share of primitive tests that it removes, memory of leaves "
         "of "
         "16 with it relative to leaves of 1 without, ours / the paper's\n\n" +
         summary_table(rows) + "\n### Fig. 5: times relative to leaves of 1, ours / the paper's\n\n" +
         time_table(rows) + "\n### Split clipping, ours\n\n" + clipping_table(rows) +
         "\n### The same culling in the 4-wide tree, ours\n\n" + wide_table(rows);
}

}  // namespace ctu::sim::paper
