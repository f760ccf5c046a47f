#include "sim/metamorph/leaks.h"

#include <string_view>

#include <fmt/format.h>

#include "sim/hit_judge.h"

namespace ctu::sim::metamorph {
namespace {

/// In exact arithmetic the ray meets a triangle before it can be said to have gone through.
bool crosses(const HitJudge& judge, const AimedRay& aimed) {
  intersect::Ray part = aimed.ray;
  part.tmax = aimed.latest_t;
  return judge.meets_any(part);
}

bool went_through(const AimedRay& aimed, const intersect::Hit& hit) {
  return hit.primitive == intersect::kNoPrimitive || hit.t > aimed.latest_t;
}

}  // namespace

Leaks find_leaks(const scene::Mesh& mesh, const World& world, const std::vector<AimedRay>& aimed, int threads,
                 const TellDefect& tell) {
  std::vector<intersect::Ray> rays;
  rays.reserve(aimed.size());
  for (const AimedRay& one : aimed) rays.push_back(one.ray);
  const Asked asked = ask_all(world, rays, threads, Record::Hits);
  const HitJudge judge(mesh);
  Leaks found;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto leaks = [&](std::string_view who, const intersect::Hit& hit) {
      ++found.leaks;
      tell(fmt::format("{} LEAKS: {}: {} found where t is to be {:a} at most", who, words(rays[i]), words(hit),
                       aimed[i].latest_t));
    };
    std::vector<std::size_t> through;
    for (std::size_t d = 0; d < world.designs(); ++d)
      if (went_through(aimed[i], asked.answers[d].hits[i])) through.push_back(d);
    const bool all_triangles = went_through(aimed[i], asked.best[i]);
    if (through.empty() && !all_triangles) continue;
    if (!crosses(judge, aimed[i])) {
      ++found.passed_by;
      continue;
    }
    if (all_triangles) leaks("the triangle test alone", asked.best[i]);
    for (const std::size_t d : through) {
      const intersect::Hit &plain = asked.answers[0].hits[i], &hit = asked.answers[d].hits[i];
      const bool ideal_only = world.design(d) == cull::Design::Ideal && !went_through(aimed[i], plain);
      if (ideal_only && judge.judge(rays[i], plain, hit) != Verdict::Lost)
        ++found.declined;
      else
        leaks(to_string(world.design(d)), hit);
    }
  }
  return found;
}

}  // namespace ctu::sim::metamorph
