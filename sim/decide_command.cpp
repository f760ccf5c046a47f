// `ctusim decide`: what `record --culling auto` would choose for scenes, and what the choice costs when all rays are
// simulated.
#include <algorithm>
#include <array>
#include <cstdio>

#include <fmt/format.h>

#include "model/base/parallel.h"
#include "sim/commands.h"
#include "sim/config_file.h"
#include "sim/culling_decision.h"
#include "sim/scene_args.h"
#include "sim/scene_list.h"

namespace ctu::sim {
namespace {

/// Auto may be so much slower than the better of on and off, in percent.
constexpr double kAllowedRegretPercent = 1;

/// Simulated cycles per ray of every ray.
struct Truth {
  double off = 0, on = 0, chosen = 0;
  std::uint64_t rays = 0, wrong_hits = 0;
  double regret_percent() const { return 100 * (chosen / std::min(off, on) - 1); }
};

Truth simulate_all(const scene::Scene& scene, traces::RecordedTree tree, const CullingDecision& decision,
                   const traces::RecordOptions& options, const pipeline::UnitConfig& config) {
  const traces::RayGenerator generator(scene, options.rays);
  const cull::MaskTester none(cull::Design::None, options.masks);
  const RaySample all = sample_rays(generator, reference::Traversal(tree.bvh, nullptr, none), {}, options.threads);
  const std::string& choice = decision.tree.culling.choice;
  std::array<SampleRun, 3> runs;  // without masks, with all, with some
  parallel_chunks(choice == "partial" ? 3 : 2, 1, options.threads, [&](std::size_t i, std::size_t) {
    runs[i] = simulate_sample(i == 2 ? decision.tree : tree, i != 0, all, options, config);
  });
  const SampleRun& chosen = runs[choice == "partial" ? 2 : choice == "on" ? 1 : 0];
  Truth truth{runs[0].cycles_per_ray(), runs[1].cycles_per_ray(), chosen.cycles_per_ray(), all.rays.size(), 0};
  for (const SampleRun& run : runs) truth.wrong_hits += run.unit.wrong_hits;
  return truth;
}

void print_header(bool markdown) {
  if (markdown)
    fmt::print(
        "| scene | rays | off | partial | on | nodes with masks | auto | off, all rays | on | auto | against the "
        "better "
        "|\n| --- | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: | ---: |\n");
  else
    fmt::print("{:<20}{:>9}{:>10}{:>10}{:>10}{:>8}  {:<8}{:>10}{:>10}{:>10}{:>9}\n", "scene", "rays", "off", "partial",
               "on", "masked", "auto", "off, all", "on", "auto", "regret");
}

void print_row(const std::string& scene, const traces::CullingChoice& said, const Truth& truth, std::size_t nodes,
               bool markdown) {
  const auto cycles = [&](std::size_t i) { return said.forecasts.at(i).cycles_per_ray; };
  const double masked = 100 * static_cast<double>(said.forecasts.at(1).masked_nodes) / static_cast<double>(nodes);
  const char* const format =
      markdown ? "| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.1f} % | {} | {:.2f} | {:.2f} | {:.2f} | {:+.2f} % |\n"
               : "{:<20}{:>9}{:>10.2f}{:>10.2f}{:>10.2f}{:>6.1f} %  {:<8}{:>10.2f}{:>10.2f}{:>10.2f}{:>7.2f} %\n";
  fmt::print(fmt::runtime(format), scene, truth.rays, cycles(0), cycles(1), cycles(2), masked, said.choice, truth.off,
             truth.on, truth.chosen, truth.regret_percent());
  std::fflush(stdout);
}

}  // namespace

int decide_command(const DecideArgs& args) {
  DecisionOptions decision_options;
  decision_options.config = load_config(args.unit.config_path, args.unit.sets);
  decision_options.pilot_rays = args.pilot_rays;
  const traces::RecordOptions options = record_options(args.scene);
  require_possible(decision_options.config.mask_test.design, options.masks);
  bool held = true;
  print_header(args.markdown);
  for (const ListedScene& listed : listed_scenes(args.scene)) {
    const std::optional<scene::Scene> scene = load_listed(args.scene, listed);
    if (!scene) continue;
    const traces::RecordedTree tree = traces::build_tree(*scene, options);
    const CullingDecision decision = decide_culling(*scene, tree, options, decision_options);
    const Truth truth = simulate_all(*scene, tree, decision, options, decision_options.config);
    print_row(listed.name, decision.tree.culling, truth, tree.bvh.nodes.size(), args.markdown);
    held &= truth.regret_percent() <= kAllowedRegretPercent;
  }
  return held ? 0 : 1;
}

}  // namespace ctu::sim
