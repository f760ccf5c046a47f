#include "sim/culling_survey.h"

#include "model/accel/build.h"
#include "sim/stopwatch.h"
#include "traces/mask_set.h"

namespace ctu::sim {

using cull::Design;

CullingSurvey survey_culling(const scene::Scene& scene, const traces::RecordOptions& options,
                             const std::vector<Design>& designs, const std::function<void(std::uint64_t)>& progress) {
  CullingSurvey survey;
  survey.triangles = scene.mesh.triangles.size();
  const Stopwatch build_watch;
  const accel::Bvh4 bvh = accel::build(scene.mesh, options.build);
  survey.build_seconds = build_watch.seconds();
  const Stopwatch mask_watch;
  const traces::MaskSet set = traces::make_masks(bvh, options.masks, options.threads);
  survey.mask_seconds = mask_watch.seconds();

  survey.designs.push_back(Design::None);
  for (const Design design : designs)
    if (design != Design::None) survey.designs.push_back(design);
  std::vector<cull::MaskTester> testers;
  for (const Design design : survey.designs) testers.emplace_back(design, options.masks, set.lut);
  std::vector<Contender> contenders;
  for (const cull::MaskTester& tester : testers) contenders.push_back({&tester, &set.masks});

  const Stopwatch trace_watch;
  survey.rays = survey_rays(scene, bvh, contenders, {.rays = options.rays, .threads = options.threads}, progress);
  survey.trace_seconds = trace_watch.seconds();
  return survey;
}

}  // namespace ctu::sim
