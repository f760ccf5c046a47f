#include "sim/metamorph/hit_changes.h"

#include <utility>

#include <fmt/format.h>

#include "model/intersect/triangle_test.h"
#include "sim/hit_judge.h"

namespace ctu::sim::metamorph {
namespace {

using cull::Design;
using intersect::Hit;
using intersect::Ray;

bool found(const Hit& hit) { return hit.primitive != intersect::kNoPrimitive; }

std::string lost_hit(Design design, const Ray& ray, const Hit& expected, const Hit& answer) {
  return fmt::format("{} LOST A HIT: {}: {} expected, {} found", to_string(design), words(ray), words(expected),
                     words(answer));
}

}  // namespace

HitChanges& HitChanges::operator+=(const HitChanges& other) {
  lost += other.lost;
  near_misses += other.near_misses;
  ties += other.ties;
  return *this;
}

std::string words(const Ray& ray) {
  return fmt::format("{} origin {:a} {:a} {:a} direction {:a} {:a} {:a} t [{:a}, {:a}]",
                     ray.kind == intersect::RayKind::AnyHit ? "any-hit" : "closest-hit", ray.origin.x, ray.origin.y,
                     ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.tmin, ray.tmax);
}

std::string words(const Hit& hit) {
  return found(hit) ? fmt::format("primitive {} at {:a}", hit.primitive, hit.t) : "nothing";
}

Asked ask_all(const World& world, std::vector<Ray> rays, int threads, Record record) {
  Asked asked{std::move(rays), {}, {}};
  for (std::size_t d = 0; d < world.designs(); ++d)
    asked.answers.push_back(ask(world.traversal(d), asked.rays, threads, record));
  asked.best = best_of_all_triangles(world.bvh(), asked.rays, threads);
  return asked;
}

HitChanges judge_hits(const scene::Mesh& mesh, const World& world, const Asked& asked, const TellDefect& tell) {
  const HitJudge judge(mesh);
  HitChanges changes;
  const auto count = [&](Design design, const Ray& ray, const Hit& expected, const Hit& answer) {
    const Verdict verdict = judge.judge(ray, expected, answer);
    ++(verdict == Verdict::Lost ? changes.lost : verdict == Verdict::NearMiss ? changes.near_misses : changes.ties);
    if (verdict == Verdict::Lost) tell(lost_hit(design, ray, expected, answer));
  };
  for (std::size_t i = 0; i < asked.rays.size(); ++i) {
    const Ray& ray = asked.rays[i];
    const Hit &best = asked.best[i], &plain = asked.answers[0].hits[i];
    const bool any_hit = ray.kind == intersect::RayKind::AnyHit;
    if (any_hit ? found(best) != found(plain) : !intersect::same_bits(best, plain))
      count(Design::None, ray, best, plain);
    for (std::size_t d = 1; d < asked.answers.size(); ++d) {
      const Hit& culled = asked.answers[d].hits[i];
      if (!intersect::same_bits(plain, culled)) count(world.design(d), ray, plain, culled);
    }
  }
  return changes;
}

WayBack judge_way_back(const scene::Mesh& mesh, const World& world, const Asked& asked,
                       const std::vector<std::uint32_t>& from, const TellDefect& tell) {
  const HitJudge judge(mesh);
  WayBack way;
  for (std::size_t i = 0; i < asked.rays.size(); ++i) {
    const Ray& ray = asked.rays[i];
    const auto& [a, b, c] = mesh.triangles[from[i]];
    const auto& v = mesh.vertices;
    const auto own = intersect::triangle_test(intersect::prepare_ray(ray), v[a], v[b], v[c], ray.tmax);
    if (!own.hit) {
      way.declined += judge.meets(ray, from[i]) ? 1 : 0;
      continue;
    }
    for (std::size_t d = 0; d < world.designs(); ++d) {
      const Hit& hit = asked.answers[d].hits[i];
      if ((found(hit) && hit.t <= own.t) || !judge.meets(ray, from[i])) continue;
      ++way.lost;
      tell(lost_hit(world.design(d), ray, {own.t, own.u, own.v, from[i]}, hit));
    }
  }
  return way;
}

}  // namespace ctu::sim::metamorph
