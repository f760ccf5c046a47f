#include "sim/hit_judge.h"

#include "tests/oracle/exact_triangle.h"

namespace ctu::sim {

using intersect::Hit;

Verdict judge_hits(const scene::Mesh& mesh, const intersect::Ray& ray, const Hit& a, const Hit& b) {
  const bool a_hits = a.primitive != intersect::kNoPrimitive, b_hits = b.primitive != intersect::kNoPrimitive;
  if (a_hits && b_hits && a.t == b.t) return Verdict::Tie;
  const Hit& first = a_hits && (!b_hits || intersect::replaces(a.t, a.primitive, b)) ? a : b;
  if (first.primitive == intersect::kNoPrimitive) return Verdict::NearMiss;
  const auto& [v0, v1, v2] = mesh.triangles[first.primitive];
  const auto& v = mesh.vertices;
  return oracle::exact_ray_triangle(ray, v[v0], v[v1], v[v2], ray.tmin, ray.tmax).hit ? Verdict::Lost
                                                                                      : Verdict::NearMiss;
}

}  // namespace ctu::sim
