// What culling does to the rays of a scene, untimed: work of each design relative to none, and every hit that changes.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "model/cull/options.h"
#include "model/scene/scene.h"
#include "sim/ray_survey.h"
#include "traces/recorder.h"

namespace ctu::sim {

struct CullingSurvey {
  std::uint64_t triangles = 0;
  double build_seconds = 0, mask_seconds = 0, trace_seconds = 0;
  std::vector<cull::Design> designs;  ///< the first is Design::None
  RaySurvey rays;                     ///< a contender for each design
};

/// Traces the rays that `options` describe with each of `designs`; the result does not depend on options.threads.
CullingSurvey survey_culling(const scene::Scene& scene, const traces::RecordOptions& options,
                             const std::vector<cull::Design>& designs,
                             const std::function<void(std::uint64_t paths_done)>& progress);

}  // namespace ctu::sim
