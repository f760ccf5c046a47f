#include "sim/paper/raydist_tables.h"

#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "sim/paper/markdown_table.h"
#include "sim/paper/published_raydist.h"

namespace ctu::sim::paper {
namespace {

using influence::AreaKind;
using Scenes = std::vector<RayDistributionScene>;

/// A sum that gives its mean; of ratios the geometric one.
class Mean {
 public:
  void add(double x) { sum_ += x, ++count_; }
  double mean() const { return count_ == 0 ? 0 : sum_ / static_cast<double>(count_); }
  std::size_t count() const { return count_; }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

/// Every light of every scene under which an area was found.
void for_each_light(const Scenes& scenes,
                    const std::function<void(const RayDistributionScene&, const LightResult&)>& visit) {
  for (const RayDistributionScene& scene : scenes)
    for (const LightResult& light : scene.lights)
      if (!light.heuristics.empty()) visit(scene, light);
}

double error_percent(double predicted, double measured) { return 100 * std::fabs(predicted - measured) / measured; }

PredictionError prediction_error_of(const Scenes& scenes, std::optional<AreaKind> kind) {
  Mean projected, surface;
  for_each_light(scenes, [&](const RayDistributionScene&, const LightResult& light) {
    if (kind && light.found_kind != *kind) return;
    for (const HeuristicResult& h : light.heuristics) {
      projected.add(error_percent(h.projected_predicted, h.crossing));
      surface.add(error_percent(h.surface_predicted, h.crossing));
    }
  });
  return {projected.mean(), surface.mean(), projected.count()};
}

std::string percent(double x) { return fmt::format("{:.1f} %", x); }

/// The geometric mean over lights of a heuristic's number over the baseline's, percent.
double relative(const Scenes& scenes, std::size_t h, double HeuristicResult::*number) {
  Mean logarithms;
  for_each_light(scenes, [&](const RayDistributionScene&, const LightResult& light) {
    const double base = light.heuristics[kBaseline].*number;
    if (base > 0 && light.heuristics[h].*number > 0) logarithms.add(std::log(light.heuristics[h].*number / base));
  });
  return 100 * std::exp(logarithms.mean());
}

double relative_shadow(const LightResult& light, std::size_t h) {
  return 100 * light.heuristics[h].shadow / light.heuristics[kBaseline].shadow;
}

}  // namespace

PredictionError prediction_error(const Scenes& scenes) { return prediction_error_of(scenes, std::nullopt); }
PredictionError prediction_error(const Scenes& scenes, AreaKind kind) { return prediction_error_of(scenes, kind); }

std::string prediction_table(const Scenes& scenes) {
  MarkdownTable table({"areas", "trees", "PAH: mean error", "SAH: mean error"}, 1);
  const auto row = [&](const char* name, const PredictionError& e) {
    table.add({name, std::to_string(e.cases), percent(e.projected), percent(e.surface)});
  };
  const auto& paper = kPublishedRayDistribution;
  row("plane", prediction_error(scenes, AreaKind::Plane));
  table.add({"&emsp;*paper*", "", percent(paper.projected_error_plane), ""});
  row("point", prediction_error(scenes, AreaKind::Point));
  table.add({"&emsp;*paper*", "", percent(paper.projected_error_point), ""});
  row("all", prediction_error(scenes));
  table.add({"&emsp;*paper*", "", percent(paper.projected_error), percent(paper.surface_error)});
  return table.text();
}

std::string heuristic_table(const Scenes& scenes) {
  MarkdownTable table({"heuristic", "all on the way", "closest hit", "shadow rays", "build time", "PAH: mean error",
                       "SAH: mean error", "depth"},
                      1);
  for (std::size_t h = 0; h < compared_heuristics().size(); ++h) {
    Mean projected, surface, depth;
    for_each_light(scenes, [&](const RayDistributionScene&, const LightResult& light) {
      const HeuristicResult& r = light.heuristics[h];
      projected.add(error_percent(r.projected_predicted, r.crossing));
      surface.add(error_percent(r.surface_predicted, r.crossing));
      depth.add(r.depth);
    });
    table.add({compared_heuristics()[h].name, percent(relative(scenes, h, &HeuristicResult::crossing)),
               percent(relative(scenes, h, &HeuristicResult::closest)),
               percent(relative(scenes, h, &HeuristicResult::shadow)),
               fmt::format("{:.2f}", relative(scenes, h, &HeuristicResult::build_seconds) / 100),
               percent(projected.mean()), percent(surface.mean()), fmt::format("{:.1f}", depth.mean())});
  }
  return table.text();
}

std::string light_table(const Scenes& scenes) {
  Cells titles{"scene", "light", "area", "LSPH + SAH: tests/ray"};
  for (std::size_t h = 1; h < compared_heuristics().size(); ++h)
    if (compared_heuristics()[h].by_light) titles.push_back(compared_heuristics()[h].name);
  MarkdownTable table(titles, 3);
  for_each_light(scenes, [&](const RayDistributionScene& scene, const LightResult& light) {
    Cells cells{scene.name, light.light.name(), to_string(light.found_kind),
                fmt::format("{:.1f}", light.heuristics[kBaseline].shadow)};
    for (std::size_t h = 1; h < light.heuristics.size(); ++h)
      if (compared_heuristics()[h].by_light) cells.push_back(percent(relative_shadow(light, h)));
    table.add(cells);
  });
  return table.text();
}

std::string selection_table(const Scenes& scenes) {
  MarkdownTable table({"scene", "light", "areas", "rays claimed", "affine", "final", "global alone", "selecting",
                       "of global", "falls back", "threshold", "memory", "hits changed", "lost"},
                      2);
  Mean ratio, memory;
  for_each_light(scenes, [&](const RayDistributionScene& scene, const LightResult& light) {
    const SelectionResult& s = light.selection;
    const double rays = static_cast<double>(std::max<std::uint64_t>(s.rays, 1)),
                 affine = static_cast<double>(std::max<std::uint64_t>(s.affine, 1));
    ratio.add(std::log(s.selecting_cost / s.global_cost));
    memory.add(s.memory_ratio);
    table.add({scene.name, light.light.name(), std::to_string(light.areas),
               percent(100 * double(light.claimed) / double(light.looked_at)), percent(100 * double(s.affine) / rays),
               percent(100 * double(s.final) / rays), fmt::format("{:.1f}", s.global_cost),
               fmt::format("{:.1f}", s.selecting_cost), percent(100 * s.selecting_cost / s.global_cost),
               percent(100 * double(s.affine - s.final) / affine), percent(100 * s.threshold()),
               fmt::format("{:.2f}", s.memory_ratio), std::to_string(s.changed), std::to_string(s.lost)});
  });
  table.add({"mean", "", "", "", "", "", "", "", percent(100 * std::exp(ratio.mean())), "", "",
             fmt::format("{:.2f}", memory.mean()), "", ""});
  table.add({"&emsp;*paper*", "", "", "", "", "", "", "", "", "", "",
             fmt::format("{:.2f}", kPublishedRayDistribution.memory_ratio), "", ""});
  return table.text();
}

std::string lookup_table(const std::vector<LookupResult>& lookups) {
  MarkdownTable table(
      {"areas", "cells", "contain a point", "named by the octree", "ns with the octree", "ns asking each"}, 0);
  for (const LookupResult& l : lookups)
    table.add({std::to_string(l.areas), std::to_string(l.cells), fmt::format("{:.2f}", l.containing),
               fmt::format("{:.2f}", l.named), fmt::format("{:.0f}", 1e9 * l.octree_seconds),
               fmt::format("{:.0f}", 1e9 * l.linear_seconds)});
  return table.text();
}

std::string raydist_report(const Scenes& scenes, const std::vector<LookupResult>& lookups) {
  const auto& paper = kPublishedRayDistribution;
  const double error = prediction_error(scenes).projected;
  std::string text;
  text +=
      "### Predicted against measured cost\n\nTests (4-wide boxes and triangles) of uniform affine rays from end to "
      "end of an area, all boxes on their way, in the trees of every heuristic.\n\n";
  text += prediction_table(scenes);
  text += fmt::format("\nGoal: PAH within {:.0f} % of measured. Reached: {} ({:.1f} %).\n\n", kProjectedErrorGoal,
                      error <= kProjectedErrorGoal ? "yes" : "no", error);
  text += fmt::format(
      "### Heuristics\n\nGeometric means over scenes and lights, of LSPH + SAH. The paper: PAH costs about {:.0f} "
      "times "
      "the build time of SAH and is not better in general, SPFH + SAH wins or ties everywhere at the same build time; "
      "stricter thresholds bring the mean cost from {} to {} ({:.0f} %).\n\n",
      paper.build_time_ratio, paper.loose_cost, paper.strict_cost, 100 * paper.strict_cost / paper.loose_cost);
  text += heuristic_table(scenes);
  text +=
      "\n### Shadow rays by scene and light\n\nTests of a shadow ray up to any hit in the tree of the largest area, of "
      "LSPH + SAH.\n\n";
  text += light_table(scenes);
  text += fmt::format(
      "\n### Local trees for areas found from the rays\n\nAll shadow rays: the global tree (LSPH + SAH) alone, and the "
      "trees of the areas ({}) first. *Falls back*: share of affine rays that also walk the global tree; above "
      "*threshold*, 1 - cost_local / cost_global, local trees would not pay. *Changed*: closest hits of the same rays "
      "that differ in any bit.\n\n",
      compared_heuristics()[chosen_heuristic()].name);
  text += selection_table(scenes);
  text += fmt::format(
      "\n### Looking up the areas of a point\n\nRandom boxes and frusta in a cube, an octree of {} levels; the paper's "
      "octree beats asking each area from about 8 areas on.\n\n",
      influence::kOctreeLevels);
  text += lookup_table(lookups);
  return text;
}

}  // namespace ctu::sim::paper
