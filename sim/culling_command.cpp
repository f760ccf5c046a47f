// `ctusim culling`: intersections with each design relative to none, and every hit that changes.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "sim/commands.h"
#include "sim/culling_survey.h"
#include "sim/progress.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"

namespace ctu::sim {
namespace {

void print_header(const std::vector<cull::Design>& designs, bool markdown) {
  std::string names, rule;
  for (std::size_t i = 1; i < designs.size(); ++i) {
    names += markdown ? fmt::format(" {} |", to_string(designs[i])) : fmt::format("{:>13}", to_string(designs[i]));
    rule += " ---: |";
  }
  if (markdown)
    fmt::print(
        "| scene | rays | number of rays | intersections/ray |{} uncertain | lost hits | near misses | ties |\n"
        "| --- | --- | ---: | ---: |{} ---: | ---: | ---: | ---: |\n",
        names, rule);
  else
    fmt::print("{:<22}{:<9}{:>10}{:>13}{}{:>11}{:>7}{:>7}{:>7}\n", "scene", "rays", "number", "inters./ray", names,
               "uncertain", "lost", "near", "ties");
}

/// A share of box hits, in parts per million of them.
double per_million(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : 1e6 * double(part) / double(whole);
}

void print_row(const std::string& scene, const std::string& rays, const RaySurvey& survey, bool markdown) {
  const double base = double(survey.contenders[0].counts.intersections());
  std::string ratios;
  std::uint64_t lost = 0, near = 0, ties = 0;
  double uncertain = 0;
  for (std::size_t i = 1; i < survey.contenders.size(); ++i) {
    const ContenderSurvey& row = survey.contenders[i];
    const double percent = base == 0 ? 100 : 100 * double(row.counts.intersections()) / base;
    ratios += markdown ? fmt::format(" {:.1f} % |", percent) : fmt::format("{:>11.1f} %", percent);
    lost += row.lost_hits;
    near += row.near_misses;
    ties += row.ties;
    uncertain = std::max(uncertain, per_million(row.counts.uncertain, row.counts.box_hits));
  }
  const auto& counts = survey.contenders[0].counts;
  if (markdown)
    fmt::print("| {} | {} | {} | {:.2f} |{} {:.1f} ppm | {} | {} | {} |\n", scene, rays, counts.rays,
               counts.intersections_per_ray(), ratios, uncertain, lost, near, ties);
  else
    fmt::print("{:<22}{:<9}{:>10}{:>13.2f}{}{:>7.1f} ppm{:>7}{:>7}{:>7}\n", scene, rays, counts.rays,
               counts.intersections_per_ray(), ratios, uncertain, lost, near, ties);
  std::fflush(stdout);
}

void print_changed(const std::string& scene, const CullingSurvey& survey) {
  constexpr std::size_t kListed = 20;
  const std::vector<ChangedHit>& changed = survey.rays.changed;
  for (std::size_t i = 0; i < changed.size() && i < kListed; ++i) {
    const ChangedHit& c = changed[i];
    fmt::print(stderr,
               "{}: {} {}: origin {:a} {:a} {:a} direction {:a} {:a} {:a} t [{:a}, {:a}]: without culling primitive {} "
               "at {:a}, "
               "with it {} at {:a}\n",
               scene, to_string(survey.designs[c.contender]), to_string(c.verdict), c.ray.origin.x, c.ray.origin.y,
               c.ray.origin.z, c.ray.direction.x, c.ray.direction.y, c.ray.direction.z, c.ray.tmin, c.ray.tmax,
               c.without.primitive, c.without.t, static_cast<std::int32_t>(c.with.primitive), c.with.t);
  }
}

/// What to trace of each scene, a kind of rays each, checked before the first scene is loaded.
std::vector<std::pair<std::string, traces::RecordOptions>> surveys_of(const CullingArgs& args,
                                                                      const std::vector<cull::Design>& designs) {
  std::vector<std::pair<std::string, traces::RecordOptions>> surveys;
  for (const std::string& kind : ray_kinds(args.scene.rays)) {
    SceneArgs one = args.scene;
    one.rays = kind;
    surveys.emplace_back(kind, record_options(one));
  }
  for (const cull::Design design : designs) require_possible(design, surveys.front().second.masks);
  return surveys;
}

}  // namespace

int culling_command(const CullingArgs& args) {
  const auto designs = parse_designs(args.designs);
  const auto surveys = surveys_of(args, designs);
  bool lost = false, first = true;
  for (const ListedScene& listed : listed_scenes(args.scene)) {
    const std::optional<scene::Scene> scene = load_listed(args.scene, listed);
    if (!scene) continue;
    for (const auto& [kind, options] : surveys) {
      CullingSurvey survey;
      {
        Progress bar(listed.name, 0, "paths");
        survey = survey_culling(*scene, options, designs, [&](std::uint64_t done) { bar.update(done); });
      }
      if (first) print_header(survey.designs, args.markdown);
      first = false;
      print_row(listed.name, kind, survey.rays, args.markdown);
      print_changed(listed.name, survey);
      for (const ContenderSurvey& row : survey.rays.contenders) lost |= row.lost_hits != 0;
    }
  }
  return lost ? 1 : 0;
}

}  // namespace ctu::sim
