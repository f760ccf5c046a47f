#include "sim/hit_judge.h"

#include <algorithm>

#include "model/intersect/triangle_test.h"
#include "tests/oracle/ray_oracle.h"

namespace ctu::sim {
namespace {

using intersect::Hit;
using intersect::Ray;

bool found(const Hit& hit) { return hit.primitive != intersect::kNoPrimitive; }

}  // namespace

const char* to_string(Verdict verdict) {
  return verdict == Verdict::Lost ? "LOST A HIT" : verdict == Verdict::NearMiss ? "near miss" : "tie";
}

bool HitJudge::meets(const Ray& ray, std::uint32_t primitive) const {
  if (primitive == intersect::kNoPrimitive) return false;
  const auto& [a, b, c] = mesh_.triangles[primitive];
  return oracle::RayOracle(ray).meets_triangle(mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]);
}

bool HitJudge::meets_any(const Ray& ray) const {
  oracle::RayOracle exact(ray);
  return std::any_of(mesh_.triangles.begin(), mesh_.triangles.end(), [&](const auto& t) {
    return exact.meets_triangle(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  });
}

Verdict HitJudge::judge(const Ray& ray, const Hit& without, const Hit& with) const {
  const bool any_hit = ray.kind == intersect::RayKind::AnyHit;
  if (found(without) && found(with) && (any_hit || without.t == with.t)) return Verdict::Tie;
  const Hit& later = found(without) && (!found(with) || without.t < with.t) ? with : without;
  Ray up_to_answer = ray;
  if (found(later)) up_to_answer.tmax = later.t;
  oracle::RayOracle exact(up_to_answer);
  const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
  const auto unaccounted = [&](const auto& t) {
    const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
    if (!exact.meets_triangle(a, b, c)) return false;
    const auto own = intersect::triangle_test(prepared, a, b, c, ray.tmax);
    return own.hit && (!found(later) || own.t < later.t);
  };
  if (std::any_of(mesh_.triangles.begin(), mesh_.triangles.end(), unaccounted)) return Verdict::Lost;
  const Hit& sooner = &later == &with ? without : with;
  return meets(ray, sooner.primitive) ? Verdict::Tie : Verdict::NearMiss;
}

}  // namespace ctu::sim
