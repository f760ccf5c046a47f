// The same rays through several traversals, untimed: the work of each, every ray whose hit is not the one without
// culling, judged by exact arithmetic, and, where asked, the processor's time.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/intersect/ray.h"
#include "model/reference/step.h"
#include "model/scene/scene.h"
#include "sim/hit_judge.h"
#include "traces/ray_options.h"

namespace ctu::sim {

/// A way to cull. Both must outlive the survey; `masks` may be null when the tester's design is none.
struct Contender {
  const cull::MaskTester* tester = nullptr;
  const cull::ObjectMasks* masks = nullptr;
  bool timed = false;
};

struct ChangedHit {
  std::size_t contender = 0;
  intersect::Ray ray;
  intersect::Hit without, with;
  Verdict verdict = Verdict::Lost;
};

struct ContenderSurvey {
  reference::Counts counts;
  std::uint64_t lost_hits = 0, near_misses = 0, ties = 0;
  /// Processor time of each repeat over the timed rays, summed over threads; empty when not timed.
  std::vector<double> seconds;
};

struct SurveyOptions {
  traces::RayOptions rays;
  int threads = 1;
  int timed_repeats = 0;  ///< 0: no contender is timed
  int timed_every = 1;    ///< 1: all rays; n: those of every nth chunk of paths
};

struct RaySurvey {
  std::vector<ContenderSurvey> contenders;  ///< in the order given
  std::vector<ChangedHit> changed;
  std::uint64_t timed_rays = 0;
};

/// Makes the rays that `options.rays` describes, a chunk at a time, and traces each chunk with every contender. The
/// first contender must not cull: its hits are what the others are compared with. Timed contenders take turns over
/// each chunk, once a repeat and without recording steps. All but the seconds is the same for any number of threads.
RaySurvey survey_rays(const scene::Scene& scene, const accel::Bvh4& bvh, const std::vector<Contender>& contenders,
                      const SurveyOptions& options, const std::function<void(std::uint64_t paths_done)>& progress);

}  // namespace ctu::sim
