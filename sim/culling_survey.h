// What culling does to the rays of a scene, untimed: work of each design relative to none, and every ray whose hit
// changes, judged by exact arithmetic.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "model/cull/options.h"
#include "model/intersect/ray.h"
#include "model/reference/step.h"
#include "model/scene/scene.h"
#include "traces/recorder.h"

namespace ctu::sim {

/// What became of a ray whose hit with culling is not the one without.
enum class Verdict : std::uint8_t {
  Lost,      ///< in exact arithmetic the ray meets the triangle found without culling: a defect
  NearMiss,  ///< it does not: only the rounded triangle test accepts it
  Tie,       ///< another triangle at the same t, bit for bit: where two meet, rounding decides which one comes first
};

struct ChangedHit {
  cull::Design design = cull::Design::None;
  intersect::Ray ray;
  intersect::Hit without, with;
  Verdict verdict = Verdict::Lost;
};

struct DesignSurvey {
  cull::Design design = cull::Design::None;
  reference::Counts counts;
  std::uint64_t lost_hits = 0, near_misses = 0, ties = 0;
};

struct Survey {
  std::uint64_t triangles = 0;
  double build_seconds = 0, mask_seconds = 0, trace_seconds = 0;
  std::vector<DesignSurvey> designs;  ///< the first is Design::None
  std::vector<ChangedHit> changed;
};

/// Traces the rays that `options` describe with each of `designs`; the result does not depend on options.threads.
Survey survey_culling(const scene::Scene& scene, const traces::RecordOptions& options,
                      const std::vector<cull::Design>& designs,
                      const std::function<void(std::uint64_t done, std::uint64_t total)>& progress);

}  // namespace ctu::sim
