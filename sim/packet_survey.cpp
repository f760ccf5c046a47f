#include "sim/packet_survey.h"

#include <algorithm>

#include "sim/culling_decision.h"
#include "sim/hit_judge.h"
#include "sim/ray_sample.h"

namespace ctu::sim {
namespace {

std::uint64_t counter(const pipeline::UnitResult& result, const std::string& name) {
  return result.counter(name).value_or(0);
}

RaySample in_order(const RaySample& sample, const std::vector<std::uint32_t>& order) {
  RaySample sorted;
  sorted.whole = sample.whole;
  for (const std::uint32_t i : order) {
    sorted.rays.push_back(sample.rays[i]);
    sorted.hits.push_back(sample.hits[i]);
  }
  return sorted;
}

PacketRun run_of(const SampleRun& sample, const reference::PacketPlan& plan) {
  const pipeline::UnitResult& unit = sample.unit;
  const auto per_ray = [&](std::uint64_t count) {
    return unit.rays == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(unit.rays);
  };
  PacketRun run;
  run.plan = plan;
  run.node_tests = per_ray(unit.counts.node_visits);
  run.triangle_tests = per_ray(unit.counts.triangle_tests);
  run.packet_visits = per_ray(counter(unit, "packets.node_visits"));
  run.node_tests_saved = per_ray(counter(unit, "packets.node_tests_saved"));
  const std::uint64_t packets = counter(unit, "packets.packets");
  run.entries = packets == 0 ? 0 : static_cast<double>(counter(unit, "packets.entries")) / static_cast<double>(packets);
  run.memory_lines = per_ray(counter(unit, "node_fetch.fills") + counter(unit, "leaf_fetch.fills"));
  run.cycles = sample.cycles_per_ray();
  return run;
}

/// Hits that are not bit for bit those of the sample; the unit lists a few of them, so a reference finds them again.
void judge(const scene::Scene& scene, const RaySample& sample, SampleFeed& feed, const reference::Traversal& traversal,
           const accel::Bvh4& bvh, PacketRun& run) {
  const HitJudge judge(scene.mesh);
  while (const auto block = feed.next()) {
    reference::StepList steps;
    const std::vector<intersect::Hit> hits =
        reference::PacketWalk(bvh, run.plan, block->rays, block->packets).trace(traversal, steps);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const std::size_t ray = block->first_ray + i;
      if (intersect::same_bits(hits[i], block->expected[i])) continue;
      const Verdict verdict = judge.judge(sample.rays[ray], sample.hits[ray], hits[i]);
      ++(verdict == Verdict::Lost ? run.lost : verdict == Verdict::NearMiss ? run.near_misses : run.ties);
    }
  }
}

}  // namespace

std::vector<PacketRun> survey_packets(const scene::Scene& scene, const traces::RecordedTree& tree,
                                      const traces::RecordOptions& recorded, const PacketSurveyOptions& options,
                                      const std::function<void(std::uint64_t)>& runs_done) {
  const cull::Design design = options.config.mask_test.design;
  const bool with_masks = design != cull::Design::None;
  const cull::MaskTester none(cull::Design::None, recorded.masks),
      tester(design, recorded.masks, with_masks ? tree.masks.lut : nullptr);
  const reference::Traversal alone(tree.bvh, nullptr, none), traversal(tree.bvh, &tree.masks.masks, tester);
  const traces::RayGenerator generator(scene, recorded.rays);
  const RaySample sample = sample_rays(generator, alone, {.rays = options.rays}, recorded.threads);
  std::vector<PacketRun> runs;
  if (sample.rays.empty()) return runs;
  runs.push_back(run_of(simulate_sample(tree, with_masks, sample, recorded, options.config), {}));
  for (const int size : options.sizes) {
    const reference::FormingOptions forming{
        .size = size, .window = std::max(options.window, size), .forming = options.forming};
    const RaySample sorted = in_order(sample, reference::packet_order(sample.rays, forming));
    for (const int entries : options.entries) {
      traces::RecordOptions in_packets = recorded;
      in_packets.packets.plan = {size, entries};
      PacketRun run =
          run_of(simulate_sample(tree, with_masks, sorted, in_packets, options.config), in_packets.packets.plan);
      SampleFeed feed(sorted, tree.bvh, &tree.masks.masks, tester, run.plan);
      judge(scene, sorted, feed, traversal, tree.bvh, run);
      runs.push_back(run);
      runs_done(runs.size());
    }
  }
  return runs;
}

}  // namespace ctu::sim
