#include "sim/unit_runner.h"

#include <optional>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/nearest.h"
#include "model/reference/block_walk.h"
#include "model/reference/traversal.h"
#include "sim/config_file.h"
#include "sim/energy/unit_shape.h"
#include "sim/ladder/estimate.h"
#include "sim/progress.h"
#include "sim/rtl_runner.h"
#include "sim/stopwatch.h"

namespace ctu::sim {
namespace {

template <class Value>
Value parse_choice(const std::string& option, const std::string& name,
                   const std::vector<std::pair<std::string, Value>>& choices) {
  std::vector<std::string> known;
  for (const auto& [text, value] : choices) {
    if (text == name) return value;
    known.push_back(text);
  }
  throw Error(option, fmt::format("unknown value \"{}\"", name),
              fmt::format("did you mean \"{}\"?", nearest_name(name, known)));
}

const std::vector<std::pair<std::string, unit::Mode>> kModes = {{"plain", unit::Mode::Plain},
                                                                {"batch", unit::Mode::Batch},
                                                                {"cycle", unit::Mode::Cycle},
                                                                {"pins", unit::Mode::Pins}};
const std::vector<std::pair<std::string, unit::Source>> kSources = {{"replay", unit::Source::Replay},
                                                                    {"exec", unit::Source::Exec}};

template <class Value>
std::string name_of(Value value, const std::vector<std::pair<std::string, Value>>& choices) {
  for (const auto& [text, candidate] : choices)
    if (candidate == value) return text;
  return "";
}

/// The untimed traversal over the same rays: every hit checked, everything counted.
pipeline::UnitResult run_reference(const LoadedTrace& trace, const cull::MaskTester& tester, traces::RayRange range) {
  std::vector<accel::PrimitiveBox> boxes;
  if (trace.reader().has_primitive_boxes()) boxes = reference::leaf_boxes(trace.bvh());
  const reference::Traversal traversal(trace.bvh(), &trace.masks(), tester, boxes.empty() ? nullptr : &boxes,
                                       cull::RayBoxRule::OncePerLeaf);
  traces::TraceFeed feed(trace.reader(), range);
  pipeline::UnitResult result;
  constexpr std::size_t kListedWrongHits = 16;
  while (const auto block = feed.next()) {
    reference::RayBlock walked = *block;
    const std::vector<intersect::Hit> hits = reference::walk_block(traversal, feed.packets(), walked);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      ++result.rays;
      if (same_bits(hits[i], block->expected[i])) continue;
      ++result.wrong_hits;
      if (result.first_wrong.size() < kListedWrongHits)
        result.first_wrong.push_back({block->first_ray + i, block->expected[i], hits[i]});
    }
    result.counts += reference::count_steps(walked.steps, 0, walked.steps.rays());
  }
  return result;
}

/// Runs and times: the simulation with the reading of its rays, not the loading and table building before it.
template <class Run>
void run_timed(RunRecord& record, Run&& run) {
  const Stopwatch wall;
  const ProcessStopwatch processor;
  record.result = run();
  record.wall_seconds = wall.seconds();
  record.processor_seconds = processor.seconds();
}

void run_cycle(const LoadedTrace& trace, const cull::MaskTester& tester, const RunPlan& plan, RunRecord& record) {
  const accel::Image image = trace.unit_image(tester.design());
  traces::TraceFeed feed = plan.options.source == unit::Source::Replay
                               ? traces::TraceFeed(trace.reader(), plan.range, trace.bvh(), &trace.masks(), tester)
                               : traces::TraceFeed(trace.reader(), plan.range);
  Progress bar("running", feed.total_rays(), "rays");
  unit::RunOptions options = plan.options;
  options.progress = [&](std::uint64_t rays) { bar.update(rays); };
  run_timed(record, [&] { return unit::run(plan.config, {image, tester, feed}, options); });
}

/// In closed form. What a run counts of its rays, the profile, is part of the time when it was not counted before.
void run_estimate(const LoadedTrace& trace, const cull::MaskTester& tester, const RunPlan& plan, RunRecord& record) {
  const ladder::TraceWork work{trace.reader(), trace.bvh(), &trace.masks(), tester, plan.range};
  const ladder::ProfileStore store;
  const std::string name = ladder::profile_name(work, plan.config);
  const Stopwatch look_up;
  std::optional<ladder::VisitProfile> profile = store.find(name);
  const double look_up_seconds = look_up.seconds();
  std::optional<accel::Image> image;
  if (!profile) image = trace.unit_image(tester.design());
  run_timed(record, [&] {
    if (!profile) profile = ladder::profile_of(work, *image, plan.config);
    ladder::Estimate estimate = ladder::estimate(work, *profile, plan.config);
    record.approximation.limit = estimate.limit;
    return std::move(estimate.result);
  });
  if (image) store.keep(name, *profile);
  record.wall_seconds += look_up_seconds;
  record.processor_seconds += look_up_seconds;
}

void run_chunks(const LoadedTrace& trace, const cull::MaskTester& tester, const RunPlan& plan, RunRecord& record) {
  const ladder::TraceWork work{trace.reader(), trace.bvh(), &trace.masks(), tester, plan.range};
  const accel::Image image = trace.unit_image(tester.design());
  run_timed(record, [&] {
    ladder::Sampled sampled = ladder::run_sampled(work, image, plan.config, plan.sampled);
    Approximation& a = record.approximation;
    a.confidence = 100 * plan.sampled.confidence;
    a.cycles_low = sampled.cycles_low;
    a.cycles_high = sampled.cycles_high;
    a.chunks = sampled.chunks;
    a.simulated_rays = sampled.simulated_rays;
    a.simulated_cycles = sampled.simulated_cycles;
    return std::move(sampled.result);
  });
}

}  // namespace

unit::Mode parse_mode(const std::string& name) { return parse_choice("--mode", name, kModes); }
unit::Source parse_source(const std::string& name) { return parse_choice("--source", name, kSources); }

unit::RunOptions run_options(const UnitArgs& args) {
  unit::RunOptions options;
  options.mode = parse_mode(args.mode);
  options.source = parse_source(args.source);
  return options;
}

void require_engine(const std::string& engine) {
  for (const char* known : {"cycle", "reference", "rtl", "both", "estimate", "sampled"})
    if (engine == known) return;
  throw Error("--engine", fmt::format("there is no engine \"{}\" in this version", engine),
              "give cycle, reference, rtl, both, estimate or sampled");
}

RunRecord run_plan(const LoadedTrace& trace, const RunPlan& plan) {
  const cull::MaskTester tester = trace.tester(plan.config.mask_test.design);
  const reference::PacketPlan packets = trace.reader().manifest().packets.plan;
  const energy::UnitShape shape =
      energy::unit_shape(plan.config, trace.unit_image(tester.design()), tester, packets.size, packets.most_entries);
  if (plan.parts) tailor::require_parts(*plan.parts, shape, trace.reader().path());
  RunRecord record;
  record.engine = plan.engine;
  record.mode = name_of(plan.options.mode, kModes);
  record.source = name_of(plan.options.source, kSources);
  record.trace_path = trace.reader().path();
  record.trace_hash = trace.reader().hash();
  record.scene = trace.reader().manifest().scene.name;
  record.config = plan.config;
  record.config_hash = config_hash(plan.config);
  record.design = cull::to_string(plan.config.mask_test.design);
  if (plan.engine == "reference")
    run_timed(record, [&] { return run_reference(trace, tester, plan.range); });
  else if (plan.engine == "rtl")
    run_timed(record, [&] { return run_rtl(trace, tester, plan); });
  else if (plan.engine == "both")
    run_timed(record, [&] { return run_both(trace, tester, plan, record.twins); });
  else if (plan.engine == "sampled")
    run_chunks(trace, tester, plan, record);
  else if (plan.engine == "estimate")
    run_estimate(trace, tester, plan, record);
  else
    run_cycle(trace, tester, plan, record);
  record.cost = energy::cost_of_run(shape, record.result, plan.energy);
  return record;
}

}  // namespace ctu::sim
