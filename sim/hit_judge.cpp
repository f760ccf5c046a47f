#include "sim/hit_judge.h"

#include "model/accel/leaf_record.h"
#include "model/intersect/sphere_test.h"
#include "model/intersect/triangle_test.h"
#include "tests/oracle/ray_oracle.h"

namespace ctu::sim {
namespace {

using intersect::Hit;
using intersect::Ray;

bool found(const Hit& hit) { return hit.primitive != intersect::kNoPrimitive; }

bool meets(oracle::RayOracle& exact, const accel::LeafTriangle& p) {
  if (p.is_sphere()) return exact.meets_sphere(p.v0, p.v1.x);
  return exact.meets_triangle(p.v0, p.v1, p.v2);
}

/// What the primitive's own test says.
intersect::TriangleResult own_test(const intersect::PreparedRay& ray, const accel::LeafTriangle& p) {
  if (!p.is_sphere()) return intersect::triangle_test(ray, p.v0, p.v1, p.v2, ray.ray.tmax);
  const intersect::SphereResult result = intersect::sphere_test(ray, p.sphere(), ray.ray.tmax);
  return {result.hit, result.t, 0, 0};
}

/// Whether `holds` is true of a primitive of the mesh.
template <class Predicate>
bool any_primitive(const scene::Mesh& mesh, Predicate holds) {
  for (std::uint32_t id = 0; id < mesh.primitives(); ++id)
    if (holds(accel::leaf_record(mesh, id))) return true;
  return false;
}

}  // namespace

const char* to_string(Verdict verdict) {
  return verdict == Verdict::Lost ? "LOST A HIT" : verdict == Verdict::NearMiss ? "near miss" : "tie";
}

bool HitJudge::meets(const Ray& ray, std::uint32_t primitive) const {
  if (primitive == intersect::kNoPrimitive) return false;
  oracle::RayOracle exact(ray);
  return sim::meets(exact, accel::leaf_record(mesh_, primitive));
}

bool HitJudge::meets_any(const Ray& ray) const {
  oracle::RayOracle exact(ray);
  return any_primitive(mesh_, [&](const accel::LeafTriangle& p) { return sim::meets(exact, p); });
}

Verdict HitJudge::judge(const Ray& ray, const Hit& without, const Hit& with) const {
  const bool any_hit = ray.kind == intersect::RayKind::AnyHit;
  if (found(without) && found(with) && (any_hit || without.t == with.t)) return Verdict::Tie;
  const Hit& later = found(without) && (!found(with) || without.t < with.t) ? with : without;
  Ray up_to_answer = ray;
  if (found(later)) up_to_answer.tmax = later.t;
  oracle::RayOracle exact(up_to_answer);
  const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
  const auto unaccounted = [&](const accel::LeafTriangle& p) {
    if (!sim::meets(exact, p)) return false;
    const intersect::TriangleResult own = own_test(prepared, p);
    return own.hit && (!found(later) || own.t < later.t);
  };
  if (any_primitive(mesh_, unaccounted)) return Verdict::Lost;
  const Hit& sooner = &later == &with ? without : with;
  return meets(ray, sooner.primitive) ? Verdict::Tie : Verdict::NearMiss;
}

}  // namespace ctu::sim
