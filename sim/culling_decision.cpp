#include "sim/culling_decision.h"

#include <algorithm>
#include <array>
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
using traces::MaskSet;

/// What is gained must be more than this share of the cycles before masks are carried: a forecast is no better.
constexpr double kIndifference = 0.001;

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
  for (const auto& counter : result.counters)
    if (counter.name == name) return static_cast<double>(counter.value);
  return 0;
}

/// Cycles that a node spends in the test of masks when nobody else is there and none of its lanes is asked.
double least_test_cycles(const pipeline::UnitConfig& config) {
  const bool compares = config.mask_test.design == cull::Design::Comparators;
  constexpr int kStages = 2, kLinkCycles = 1;
  return (compares ? config.comparators.latency : config.cell_locate.latency) + config.mask_test.latency +
         kStages * kLinkCycles;
}

traces::CullingForecast forecast(std::string name, const SampleRun& run, const accel::Bvh4& bvh, const MaskSet* masks) {
  traces::CullingForecast row;
  row.name = std::move(name);
  row.cycles_per_ray = run.cycles_per_ray();
  row.intersections_per_ray = run.unit.counts.intersections_per_ray();
  row.masked_nodes = masks == nullptr ? 0 : cull::nodes_with_masks(bvh, masks->masks);
  row.node_bytes = run.node_bytes;
  return row;
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

SampleRun simulate_sample(const accel::Bvh4& bvh, const MaskSet* masks, const RaySample& sample,
                          const traces::RecordOptions& recorded, const pipeline::UnitConfig& config) {
  pipeline::UnitConfig unit = config;
  if (masks == nullptr) unit.mask_test.design = cull::Design::None;
  const cull::MaskTester tester(unit.mask_test.design, recorded.masks, masks == nullptr ? nullptr : masks->lut);
  const accel::Image image = traces::image_of(bvh, masks, recorded.layout);
  SampleFeed feed(sample, bvh, masks == nullptr ? nullptr : &masks->masks, tester);
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

CullingDecision decide_culling(const scene::Scene& scene, const accel::Bvh4& bvh, const MaskSet& masks,
                               const traces::RecordOptions& recorded, const DecisionOptions& options) {
  const pipeline::UnitConfig& config = options.config;
  CullingDecision decision;
  traces::CullingChoice& said = decision.said;
  said.design = cull::to_string(config.mask_test.design);
  said.config_hash = config_hash(config);
  if (config.mask_test.design == cull::Design::None) {
    said.choice = "off";
    said.why = "the unit does not cull";
    return decision;
  }

  const traces::RayGenerator generator(scene, recorded.rays);
  const cull::MaskTester none(cull::Design::None, recorded.masks);
  const reference::Traversal walk(bvh, nullptr, none);
  const RaySample pilot = sample_rays(generator, walk, {.rays = options.pilot_rays}, recorded.threads);
  const RaySample others =
      pilot.whole ? pilot : sample_rays(generator, walk, {.rays = options.pilot_rays, .phase = 0.5}, recorded.threads);
  said.pilot_rays = pilot.rays.size();

  std::array<SampleRun, 2> ends;  // without masks, with all of them
  parallel_chunks(ends.size(), 1, recorded.threads, [&](std::size_t i, std::size_t) {
    ends[i] = simulate_sample(bvh, i == 0 ? nullptr : &masks, pilot, recorded, config);
  });
  said.forecasts = {forecast("off", ends[0], bvh, nullptr), forecast("on", ends[1], bvh, &masks)};

  const cull::MaskTester tester(config.mask_test.design, recorded.masks, masks.lut);
  VisitCosts costs = measured_costs(ends[0].unit, ends[1].unit, config);
  costs.mask_bytes = 0;  // a node whose masks are full is as long as the others
  const auto kept = lanes_that_pay(bvh, masks.masks, tester, others, costs, recorded.threads);
  MaskSet paying{cull::strip_masks(bvh, masks.masks, masks.lut.get(), kept), masks.lut};
  said.forecasts.push_back(forecast("partial", simulate_sample(bvh, &paying, pilot, recorded, config), bvh, &paying));

  const auto& [off, on, partial] = std::tie(said.forecasts[0], said.forecasts[1], said.forecasts[2]);
  const traces::CullingForecast* best = &off;
  for (const traces::CullingForecast* other : {&on, &partial})
    if (other->cycles_per_ray < best->cycles_per_ray * (1 - kIndifference)) best = other;
  said.choice = best->name;
  said.why = why(*best, off, on, bvh.nodes.size());
  if (best == &on) decision.masks = masks;
  if (best == &partial) decision.masks = std::move(paying);
  return decision;
}

}  // namespace ctu::sim
