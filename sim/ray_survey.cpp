#include "sim/ray_survey.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <tuple>

#include "model/base/parallel.h"
#include "model/reference/traversal.h"
#include "sim/stopwatch.h"
#include "traces/ray_generator.h"

namespace ctu::sim {
namespace {

using intersect::Hit;
using intersect::Ray;

constexpr std::size_t kPathsPerChunk = 1024;

void count(Verdict verdict, ContenderSurvey& row) {
  ++(verdict == Verdict::Lost ? row.lost_hits : verdict == Verdict::NearMiss ? row.near_misses : row.ties);
}

void add(const ContenderSurvey& part, ContenderSurvey& sum) {
  sum.counts += part.counts;
  sum.lost_hits += part.lost_hits;
  sum.near_misses += part.near_misses;
  sum.ties += part.ties;
  for (std::size_t r = 0; r < sum.seconds.size(); ++r) sum.seconds[r] += part.seconds[r];
}

/// One chunk of rays and all that is found about them.
class ChunkSurvey {
 public:
  ChunkSurvey(const std::vector<Contender>& contenders, const std::vector<reference::Traversal>& traversals,
              const HitJudge& judge, int repeats)
      : contenders_(contenders), traversals_(traversals), judge_(judge) {
    result_.contenders.resize(contenders.size());
    for (std::size_t c = 0; c < contenders.size(); ++c)
      if (contenders[c].timed) result_.contenders[c].seconds.resize(static_cast<std::size_t>(repeats));
  }

  void make_rays(const traces::RayGenerator& generator, std::size_t first_path, std::size_t last_path) {
    const auto plain = [&](const Ray& ray, bool) { return traversals_[0].trace(ray); };
    generator.generate(first_path, last_path, plain, rays_, without_);
  }

  void count_work() {
    for (std::size_t c = 0; c < traversals_.size(); ++c) {
      ContenderSurvey& row = result_.contenders[c];
      reference::StepList steps;
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        const Hit with = traversals_[c].trace(rays_[i], &steps);
        if (same_bits(with, without_[i])) continue;
        const Verdict verdict = judge_.judge(rays_[i], without_[i], with);
        count(verdict, row);
        result_.changed.push_back({c, rays_[i], without_[i], with, verdict});
      }
      row.counts += reference::count_steps(steps, 0, steps.rays());
    }
  }

  /// `turn` says who begins, so that over the chunks everybody follows everybody.
  void time(std::size_t repeats, std::size_t turn) {
    result_.timed_rays = rays_.size();
    for (std::size_t repeat = 0; repeat < repeats; ++repeat)
      for (std::size_t i = 0; i < traversals_.size(); ++i) {
        const std::size_t c = (i + turn + repeat) % traversals_.size();
        if (!contenders_[c].timed) continue;
        const ThreadStopwatch watch;
        for (const Ray& ray : rays_) traversals_[c].trace(ray);
        result_.contenders[c].seconds[repeat] += watch.seconds();
      }
  }

  const RaySurvey& result() const { return result_; }

 private:
  const std::vector<Contender>& contenders_;
  const std::vector<reference::Traversal>& traversals_;
  const HitJudge& judge_;
  std::vector<Ray> rays_;
  std::vector<Hit> without_;
  RaySurvey result_;
};

/// An order that does not depend on which thread was first.
bool before(const ChangedHit& a, const ChangedHit& b) {
  const auto key = [](const ChangedHit& c) {
    const auto& [o, d] = std::tie(c.ray.origin, c.ray.direction);
    return std::tuple(c.contender, c.without.primitive, c.without.t, o.x, o.y, o.z, d.x, d.y, d.z);
  };
  return key(a) < key(b);
}

}  // namespace

RaySurvey survey_rays(const scene::Scene& scene, const accel::Bvh4& bvh, const std::vector<Contender>& contenders,
                      const SurveyOptions& options, const std::function<void(std::uint64_t)>& progress) {
  assert(!contenders.empty() && contenders.front().tester->design() == cull::Design::None);
  assert(options.timed_every >= 1);
  std::vector<reference::Traversal> traversals;
  for (const Contender& contender : contenders) traversals.emplace_back(bvh, contender.masks, *contender.tester);
  const traces::RayGenerator generator(scene, options.rays);
  const HitJudge judge(scene.mesh);

  RaySurvey survey = ChunkSurvey(contenders, traversals, judge, options.timed_repeats).result();
  std::mutex mutex;
  std::uint64_t paths_done = 0;
  parallel_chunks(generator.paths(), kPathsPerChunk, options.threads, [&](std::size_t first, std::size_t last) {
    ChunkSurvey chunk(contenders, traversals, judge, options.timed_repeats);
    chunk.make_rays(generator, first, last);
    chunk.count_work();
    const std::size_t number = first / kPathsPerChunk;
    if (number % static_cast<std::size_t>(options.timed_every) == 0)
      chunk.time(static_cast<std::size_t>(options.timed_repeats), number);

    const std::lock_guard lock(mutex);
    const RaySurvey& part = chunk.result();
    for (std::size_t c = 0; c < part.contenders.size(); ++c) add(part.contenders[c], survey.contenders[c]);
    survey.changed.insert(survey.changed.end(), part.changed.begin(), part.changed.end());
    survey.timed_rays += part.timed_rays;
    paths_done += last - first;
    progress(paths_done);
  });
  std::sort(survey.changed.begin(), survey.changed.end(), before);
  return survey;
}

}  // namespace ctu::sim
