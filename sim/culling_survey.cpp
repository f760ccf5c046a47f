#include "sim/culling_survey.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include "model/accel/build.h"
#include "model/base/parallel.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/reference/traversal.h"
#include "tests/oracle/exact_triangle.h"
#include "traces/ray_generator.h"

namespace ctu::sim {
namespace {

using cull::Design;
using intersect::Hit;
using intersect::Ray;

constexpr std::size_t kPathsPerChunk = 1024;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A design with its tables, ready to trace.
struct Contender {
  Contender(Design d, const traces::RecordOptions& options, const accel::Bvh4& bvh, const cull::ObjectMasks& masks)
      : design(d), tester(d, options.masks), traversal(bvh, &masks, tester) {}
  Design design;
  cull::MaskTester tester;
  reference::Traversal traversal;
};

/// Judges changed hits: does the exact ray meet the triangle that only the traversal without culling found?
class Judge {
 public:
  explicit Judge(const scene::Mesh& mesh) : mesh_(mesh) {}

  Verdict judge(const Ray& ray, const Hit& without, const Hit& with) const {
    const bool both_hit = without.primitive != intersect::kNoPrimitive && with.primitive != intersect::kNoPrimitive;
    if (both_hit && without.t == with.t) return Verdict::Tie;
    return meets(ray, without.primitive) ? Verdict::Lost : Verdict::NearMiss;
  }

 private:
  bool meets(const Ray& ray, std::uint32_t primitive) const {
    if (primitive == intersect::kNoPrimitive) return false;
    const auto& [a, b, c] = mesh_.triangles[primitive];
    const auto& v = mesh_.vertices;
    return oracle::exact_ray_triangle(ray, v[a], v[b], v[c], ray.tmin, ray.tmax).hit;
  }

  const scene::Mesh& mesh_;
};

void count(Verdict verdict, DesignSurvey& row) {
  ++(verdict == Verdict::Lost ? row.lost_hits : verdict == Verdict::NearMiss ? row.near_misses : row.ties);
}

/// Rays of some paths through one design.
void trace_chunk(const Contender& contender, const std::vector<Ray>& rays, const std::vector<Hit>& without,
                 const Judge& judge, DesignSurvey& row, std::vector<ChangedHit>& changed) {
  reference::StepList steps;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit with = contender.traversal.trace(rays[i], &steps);
    if (same_bits(with, without[i])) continue;
    const Verdict verdict = judge.judge(rays[i], without[i], with);
    count(verdict, row);
    changed.push_back({contender.design, rays[i], without[i], with, verdict});
  }
  row.counts += reference::count_steps(steps, 0, steps.rays());
}

}  // namespace

Survey survey_culling(const scene::Scene& scene, const traces::RecordOptions& options,
                      const std::vector<Design>& designs,
                      const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  Survey survey;
  survey.triangles = scene.mesh.triangles.size();
  auto start = std::chrono::steady_clock::now();
  const accel::Bvh4 bvh = accel::build(scene.mesh, options.build);
  survey.build_seconds = seconds_since(start);
  start = std::chrono::steady_clock::now();
  const cull::ObjectMasks masks = cull::build_object_masks(bvh, options.masks, options.threads);
  survey.mask_seconds = seconds_since(start);

  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.push_back(std::make_unique<Contender>(Design::None, options, bvh, masks));
  for (const Design design : designs)
    if (design != Design::None) contenders.push_back(std::make_unique<Contender>(design, options, bvh, masks));
  for (const auto& contender : contenders) survey.designs.push_back({contender->design, {}, 0, 0, 0});

  start = std::chrono::steady_clock::now();
  const traces::RayGenerator generator(scene, options.rays);
  const Judge judge(scene.mesh);
  std::mutex mutex;
  std::uint64_t paths_done = 0;
  parallel_chunks(generator.paths(), kPathsPerChunk, options.threads, [&](std::size_t first, std::size_t last) {
    std::vector<Ray> rays;
    std::vector<Hit> without;
    std::vector<DesignSurvey> rows = survey.designs;
    for (DesignSurvey& row : rows) row = {row.design, {}, 0, 0, 0};
    std::vector<ChangedHit> changed;
    const auto plain = [&](const Ray& ray, bool) { return contenders[0]->traversal.trace(ray); };
    generator.generate(first, last, plain, rays, without);
    for (std::size_t d = 0; d < contenders.size(); ++d)
      trace_chunk(*contenders[d], rays, without, judge, rows[d], changed);

    const std::lock_guard lock(mutex);
    for (std::size_t d = 0; d < rows.size(); ++d) {
      survey.designs[d].counts += rows[d].counts;
      survey.designs[d].lost_hits += rows[d].lost_hits;
      survey.designs[d].near_misses += rows[d].near_misses;
      survey.designs[d].ties += rows[d].ties;
    }
    survey.changed.insert(survey.changed.end(), changed.begin(), changed.end());
    paths_done += last - first;
    progress(paths_done, generator.paths());
  });
  std::sort(survey.changed.begin(), survey.changed.end(), [](const ChangedHit& a, const ChangedHit& b) {
    return std::pair(a.design, a.without.primitive) < std::pair(b.design, b.without.primitive);
  });
  survey.trace_seconds = seconds_since(start);
  return survey;
}

}  // namespace ctu::sim
