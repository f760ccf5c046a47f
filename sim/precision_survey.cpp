#include "sim/precision_survey.h"

#include <algorithm>

#include "model/accel/build.h"
#include "model/base/parallel.h"
#include "sim/culling_decision.h"
#include "sim/hit_judge.h"
#include "sim/ray_sample.h"

namespace ctu::sim {
namespace {

using cull::Design;
using traces::RecordedTree;

/// The tree with boxes of so many bits, without masks.
RecordedTree tree_of(const accel::Bvh4& bvh, std::uint32_t box_bits, int threads) {
  RecordedTree tree;
  tree.bvh = bvh;
  if (box_bits != accel::kFullBoxBits) accel::quantize_boxes(tree.bvh, box_bits, threads);
  return tree;
}

std::uint64_t counter(const pipeline::UnitResult& result, const std::string& name) {
  return result.counter(name).value_or(0);
}

class Surveyor {
 public:
  Surveyor(const scene::Scene& scene, const traces::RecordOptions& recorded, const PrecisionOptions& options)
      : scene_(scene), recorded_(recorded), options_(options), bvh_(accel::build(scene.mesh, recorded.build)) {
    const RecordedTree first = tree_of(bvh_, options.box_bits.front(), recorded.threads);
    const cull::MaskTester none(Design::None, recorded.masks);
    const traces::RayGenerator generator(scene, recorded.rays);
    sample_ = sample_rays(generator, reference::Traversal(first.bvh, nullptr, none), {.rays = options.rays},
                          recorded.threads);
  }

  PrecisionSurvey survey(const std::function<void(std::uint64_t)>& runs_done) const {
    PrecisionSurvey survey{scene_.mesh.triangles.size(), bvh_.nodes.size(), sample_.rays.size(), {}};
    for (const std::uint32_t bits : options_.box_bits) {
      RecordedTree tree = tree_of(bvh_, bits, recorded_.threads);
      tree.masks = traces::make_masks(tree.bvh, recorded_.masks, recorded_.threads);
      std::vector<PrecisionRun> runs(options_.designs.size());
      parallel_chunks(runs.size(), 1, recorded_.threads,
                      [&](std::size_t i, std::size_t) { runs[i] = run(tree, bits, options_.designs[i]); });
      survey.runs.insert(survey.runs.end(), runs.begin(), runs.end());
      runs_done(survey.runs.size());
    }
    return survey;
  }

 private:
  PrecisionRun run(const RecordedTree& tree, std::uint32_t bits, Design design) const {
    traces::RecordOptions recorded = recorded_;
    recorded.layout.box_bits = bits;
    pipeline::UnitConfig config = options_.config;
    config.mask_test.design = design;
    const SampleRun sample = simulate_sample(tree, design != Design::None, sample_, recorded, config);
    const auto per_ray = [&](std::uint64_t count) {
      return sample_.rays.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(sample_.rays.size());
    };
    PrecisionRun run;
    run.box_bits = bits;
    run.design = design;
    run.node_bytes = sample.node_bytes;
    run.image_bytes = sample.image_bytes;
    run.intersections_per_ray = per_ray(sample.unit.counts.intersections());
    run.node_bytes_per_ray = per_ray(counter(sample.unit, "node_fetch.bytes"));
    run.memory_lines_per_ray =
        per_ray(counter(sample.unit, "node_fetch.fills") + counter(sample.unit, "leaf_fetch.fills"));
    run.cycles_per_ray = sample.cycles_per_ray();
    judge(tree, design, run);
    return run;
  }

  /// Every hit of the walk that the unit replayed.
  void judge(const RecordedTree& tree, Design design, PrecisionRun& run) const {
    const cull::MaskTester tester(design, recorded_.masks, design == Design::None ? nullptr : tree.masks.lut);
    const reference::Traversal traversal(tree.bvh, &tree.masks.masks, tester);
    const HitJudge judge(scene_.mesh);
    for (std::size_t i = 0; i < sample_.rays.size(); ++i) {
      const intersect::Hit hit = traversal.trace(sample_.rays[i]);
      if (intersect::same_bits(hit, sample_.hits[i])) continue;
      const Verdict verdict = judge.judge(sample_.rays[i], sample_.hits[i], hit);
      ++(verdict == Verdict::Lost ? run.lost_hits : verdict == Verdict::NearMiss ? run.near_misses : run.ties);
    }
  }

  const scene::Scene& scene_;
  const traces::RecordOptions& recorded_;
  const PrecisionOptions& options_;
  const accel::Bvh4 bvh_;
  RaySample sample_;
};

}  // namespace

PrecisionSurvey survey_precision(const scene::Scene& scene, const traces::RecordOptions& recorded,
                                 const PrecisionOptions& options, const std::function<void(std::uint64_t)>& runs_done) {
  return Surveyor(scene, recorded, options).survey(runs_done);
}

}  // namespace ctu::sim
