#include "sim/culling_decision.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "model/base/parallel.h"
#include "model/cull/strip_masks.h"
#include "model/pipeline/accounting.h"
#include "model/pipeline/engine.h"
#include "sim/config_file.h"

namespace ctu::sim {
namespace {

using pipeline::Place;
using pipeline::UnitResult;
using traces::RecordedTree;

/// More masks must gain more than this share of the cycles: forecasts are hardly better than that.
constexpr double kIndifference = 0.003;

double ratio(double numerator, double denominator) { return denominator > 0 ? numerator / denominator : 0; }

/// Cycles of rays' stay at some places, summed over rays.
double cycles_at(const UnitResult& result, std::initializer_list<Place> places) {
  double sum = 0;
  for (const Place place : places)
    for (const auto& cause : result.ray_cycles)
      if (cause.name == pipeline::name_of(place)) sum += static_cast<double>(cause.cycles);
  return sum;
}

double counter(const UnitResult& result, std::string_view name) {
  return static_cast<double>(result.counter(name).value_or(0));
}

/// Cycles that a node spends in the test of masks when nobody else is there and none of its lanes is asked.
double least_test_cycles(const pipeline::UnitConfig& config) {
  const bool compares = config.mask_test.design == cull::Design::Comparators;
  constexpr int kStages = 2, kLinkCycles = 1;
  return (compares ? config.comparators.latency : config.cell_locate.latency) + config.mask_test.latency +
         kStages * kLinkCycles;
}

traces::CullingForecast forecast(std::string name, const SampleRun& run, std::uint64_t masked_nodes) {
  traces::CullingForecast row;
  row.name = std::move(name);
  row.cycles_per_ray = run.cycles_per_ray();
  row.intersections_per_ray = run.unit.counts.intersections_per_ray();
  row.node_bytes = run.node_bytes;
  row.image_bytes = run.image_bytes;
  row.masked_nodes = masked_nodes;
  return row;
}

std::uint64_t nodes_with_masks(const RecordedTree& tree) { return cull::nodes_with_masks(tree.bvh, tree.masks.masks); }

/// The tree with only those masks that pay at these prices, for rays like `sample`.
RecordedTree with_paying_masks(const RecordedTree& tree, const RaySample& sample, const traces::RecordOptions& recorded,
                               const pipeline::UnitConfig& config, const VisitCosts& costs) {
  const cull::MaskTester tester(config.mask_test.design, recorded.masks, tree.masks.lut);
  const auto kept = lanes_that_pay(tree.bvh, tree.masks.masks, tester, sample, costs, recorded.threads);
  RecordedTree paying = tree;
  paying.masks.masks = cull::strip_masks(tree.bvh, tree.masks.masks, tree.masks.lut.get(), kept);
  traces::strip_full(paying);
  return paying;
}

/// The forecast to follow: the fewest cycles, and of those nearly so the one with the fewest masks.
const traces::CullingForecast& best_of(const std::vector<traces::CullingForecast>& fewest_masks_first) {
  const traces::CullingForecast* best = &fewest_masks_first.front();
  for (const traces::CullingForecast& other : fewest_masks_first)
    if (other.cycles_per_ray < best->cycles_per_ray * (1 - kIndifference)) best = &other;
  return *best;
}

std::string why(const traces::CullingForecast& best, const traces::CullingForecast& off,
                const traces::CullingForecast& on, std::uint64_t nodes) {
  const auto percent = [](double part, double whole) { return 100 * (ratio(part, whole) - 1); };
  if (best.name == "off")
    return fmt::format(
        "masks save {:.1f} % of the intersections, but nodes of {} bytes instead of {} and the test "
        "cost more: {:+.1f} % cycles with all masks",
        -percent(on.intersections_per_ray, off.intersections_per_ray), on.node_bytes, off.node_bytes,
        percent(on.cycles_per_ray, off.cycles_per_ray));
  const std::string some = best.name == "on" ? "" : fmt::format(" in {} of {} nodes", best.masked_nodes, nodes);
  return fmt::format("masks{} save {:.1f} % of the intersections and {:.1f} % of the cycles", some,
                     -percent(best.intersections_per_ray, off.intersections_per_ray),
                     -percent(best.cycles_per_ray, off.cycles_per_ray));
}

}  // namespace

double SampleRun::cycles_per_ray() const {
  return ratio(static_cast<double>(unit.cycles), static_cast<double>(unit.rays));
}

SampleRun simulate_sample(const RecordedTree& tree, bool with_masks, const RaySample& sample,
                          const traces::RecordOptions& recorded, const pipeline::UnitConfig& config) {
  pipeline::UnitConfig unit = config;
  if (!with_masks) unit.mask_test.design = cull::Design::None;
  accel::ImageLayout layout = recorded.layout;
  layout.bare_nodes = tree.bare_nodes;
  const cull::MaskTester tester(unit.mask_test.design, recorded.masks, with_masks ? tree.masks.lut : nullptr);
  const accel::Image image = traces::image_of(tree.bvh, with_masks ? &tree.masks : nullptr, layout);
  SampleFeed feed(sample, tree.bvh, &tree.masks.masks, tester, recorded.packets.plan);
  return {pipeline::run_to_end(*pipeline::make_engine(unit, {image, tester, feed}, {})), image.node_stride_bytes,
          image.bytes.size()};
}

VisitCosts measured_costs(const UnitResult& off, const UnitResult& on, const pipeline::UnitConfig& config) {
  const auto nodes = static_cast<double>(off.counts.node_visits), leaves = static_cast<double>(off.counts.leaf_visits);
  const double between = ratio(cycles_at(off, {Place::Scheduler, Place::Stack, Place::StackRefill}), nodes + leaves);
  const auto fetch = [](const UnitResult& result) {
    return ratio(cycles_at(result, {Place::NodeFetchHit, Place::NodeFetchMiss}),
                 static_cast<double>(result.counts.node_visits));
  };
  VisitCosts costs;
  costs.node = between + fetch(off) + ratio(cycles_at(off, {Place::BoxTest, Place::ChildSort}), nodes);
  costs.leaf = between + ratio(cycles_at(off, {Place::LeafFetchHit, Place::LeafFetchMiss, Place::HitUpdate}), leaves);
  costs.triangle = ratio(cycles_at(off, {Place::TriangleTest}), static_cast<double>(off.counts.triangle_tests));
  costs.mask_bytes = std::max(0.0, fetch(on) - fetch(off));
  const double test = cycles_at(on, {Place::CellLocate, Place::TableFetchHit, Place::TableFetchMiss, Place::MaskTest}) -
                      least_test_cycles(config) * static_cast<double>(on.counts.node_visits);
  costs.look_up = std::max(0.0, ratio(test, counter(on, "cell_locate.lanes")));
  return costs;
}

CullingDecision decide_culling(const scene::Scene& scene, RecordedTree tree, const traces::RecordOptions& recorded,
                               const DecisionOptions& options) {
  const pipeline::UnitConfig& config = options.config;
  traces::CullingChoice said;
  said.design = cull::to_string(config.mask_test.design);
  said.config_hash = config_hash(config);
  const auto decision = [&](RecordedTree chosen, bool with_masks) {
    if (!with_masks) chosen.masks = {};
    chosen.culling = said;
    return CullingDecision{std::move(chosen), with_masks};
  };
  if (config.mask_test.design == cull::Design::None) {
    said.choice = "off";
    said.why = "the unit does not cull";
    return decision(std::move(tree), false);
  }

  const traces::RayGenerator generator(scene, recorded.rays);
  const cull::MaskTester none(cull::Design::None, recorded.masks);
  const reference::Traversal walk(tree.bvh, nullptr, none);
  const RaySample pilot = sample_rays(generator, walk, {.rays = options.pilot_rays}, recorded.threads);
  const RaySample others =
      pilot.whole ? pilot : sample_rays(generator, walk, {.rays = options.pilot_rays, .phase = 0.5}, recorded.threads);
  said.pilot_rays = pilot.rays.size();

  SampleRun off, on;
  RecordedTree all = tree;
  if (recorded.strip_full) traces::strip_full(all);
  parallel_chunks(2, 1, recorded.threads, [&](std::size_t i, std::size_t) {
    (i == 0 ? off : on) = simulate_sample(all, i == 1, pilot, recorded, config);
  });
  RecordedTree paying = with_paying_masks(tree, others, recorded, config, measured_costs(off.unit, on.unit, config));
  const SampleRun partial = simulate_sample(paying, true, pilot, recorded, config);

  said.forecasts = {forecast("off", off, 0), forecast("partial", partial, nodes_with_masks(paying)),
                    forecast("on", on, nodes_with_masks(tree))};
  const traces::CullingForecast& best = best_of(said.forecasts);
  said.choice = best.name;
  said.why = why(best, said.forecasts.front(), said.forecasts.back(), tree.bvh.nodes.size());
  if (said.choice == "off") return decision(std::move(tree), false);
  return decision(std::move(said.choice == "on" ? all : paying), true);
}

}  // namespace ctu::sim
