// `ctusim metamorph`: whole scenes transformed, their rays reversed and aimed at edges; hits with and without culling.
#include <cstdio>
#include <vector>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/nearest.h"
#include "sim/commands.h"
#include "sim/metamorph/report.h"
#include "sim/metamorph/scene_check.h"
#include "sim/progress.h"
#include "sim/run_record.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"

namespace ctu::sim {
namespace {

using metamorph::CheckOptions;
using metamorph::Kind;

constexpr int kDefaultEntries = 256;

void add_check(const std::string& name, CheckOptions& options) {
  static const std::vector<std::pair<std::string, Kind>> kKinds{{"powers", Kind::Power},
                                                                {"factors", Kind::Factor},
                                                                {"moves", Kind::Translation},
                                                                {"axes", Kind::Permutation},
                                                                {"mirrors", Kind::Mirror}};
  bool known = name == "all";
  for (const auto& [kind_name, kind] : kKinds)
    if (name == kind_name || name == "all") options.kinds.push_back(kind), known = true;
  if (name == "reversed" || name == "all") options.reversed = known = true;
  if (name == "edges" || name == "all") options.edges = known = true;
  if (known) return;
  std::vector<std::string> names{"all", "reversed", "edges"};
  for (const auto& [kind_name, kind] : kKinds) names.push_back(kind_name);
  throw Error("--checks", fmt::format("unknown check \"{}\"", name),
              fmt::format("did you mean \"{}\"? Known: powers, factors, moves, axes, mirrors, reversed, edges, all",
                          nearest_name(name, names)));
}

CheckOptions check_options(const MetamorphArgs& args) {
  CheckOptions options;
  for (const std::string& kind : ray_kinds(args.scene.rays)) {
    SceneArgs one = args.scene;
    one.rays = kind;
    const traces::RecordOptions record = record_options(one);
    options.rays.push_back(record.rays);
    options.world.build = record.build;
    options.world.masks = record.masks;
    options.world.threads = record.threads;
  }
  if (options.world.masks.entries == 0) options.world.masks.entries = kDefaultEntries;
  options.world.designs = parse_designs(args.designs);
  for (const cull::Design design : options.world.designs) require_possible(design, options.world.masks);
  options.kinds = {Kind::Identity};
  options.reversed = options.edges = false;
  for (const std::string& check : args.checks) add_check(check, options);
  options.seed = args.scene.seed;
  options.most_aimed = args.aimed;
  return options;
}

}  // namespace

int metamorph_command(const MetamorphArgs& args) {
  const CheckOptions options = check_options(args);
  if (!args.json_path.empty()) check_writable(args.json_path);
  std::vector<metamorph::NamedReport> reports;
  bool passed = true;
  for (const ListedScene& listed : listed_scenes(args.scene)) {
    const std::optional<scene::Scene> scene = load_listed(args.scene, listed, Primitives::Triangles);
    if (!scene) continue;
    metamorph::NamedReport named{listed.name, {}};
    {
      Progress bar(listed.name, 0, "checks");
      std::uint64_t done = 0;
      named.report = check_scene(*scene, options, [&](const std::string&) { bar.update(done++); });
    }
    passed = passed && named.report.passed();
    if (!args.markdown) {
      if (reports.empty()) metamorph::print_header();
      metamorph::print_scene(named);
    }
    metamorph::print_remarks(named);
    reports.push_back(std::move(named));
  }
  if (!args.json_path.empty()) metamorph::write_json(reports, args.json_path);
  if (args.markdown) metamorph::print_markdown(reports);
  return passed ? 0 : 1;
}

}  // namespace ctu::sim
