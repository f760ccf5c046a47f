#include "sim/check/judge.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/intersect/triangle_test.h"

namespace ctu::sim::check {

using intersect::Hit;
using intersect::Ray;

namespace {

/// Exact hits at the smallest t of all.
int nearest_exact(const std::vector<Meeting>& meetings) {
  int count = 0;
  float nearest = 0;
  for (const Meeting& m : meetings) {
    if (!m.exact || !m.accepted) continue;
    if (count == 0 || m.t < nearest) nearest = m.t, count = 0;
    count += m.t == nearest;
  }
  return count;
}

}  // namespace

Judge::Judge(const CheckScene& scene) : scene_(scene), brute_force_(scene.bvh), path_(scene.node_test()) {}

bool Judge::accounts_for(const Ray& ray, const Hit& answer, const Meeting& meeting) const {
  if (answer.primitive == intersect::kNoPrimitive) return false;
  return ray.kind == intersect::RayKind::AnyHit || answer.t <= meeting.t;
}

bool Judge::is_met_by(const Ray& ray, float t, std::uint32_t triangle) const {
  Ray shortened = ray;
  shortened.tmax = t;
  const accel::LeafTriangle& at = scene_.bvh.triangles[triangle];
  return oracle::RayOracle(shortened).meets_triangle(at.v0, at.v1, at.v2);
}

bool Judge::is_some_triangles(const intersect::PreparedRay& ray, const Hit& answer,
                              const std::vector<Meeting>& meetings) const {
  if (answer.primitive == intersect::kNoPrimitive) return true;
  return std::any_of(meetings.begin(), meetings.end(), [&](const Meeting& m) {
    const accel::LeafTriangle& t = scene_.bvh.triangles[m.triangle];
    if (!m.accepted || t.primitive != answer.primitive) return false;
    const auto result = intersect::triangle_test(ray, t.v0, t.v1, t.v2, ray.ray.tmax);
    return same_bits(answer, {result.t, result.u, result.v, t.primitive});
  });
}

std::string Judge::judge(const Ray& ray, const Hit& answer, Tally& tally) {
  const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
  const std::vector<Meeting>& meetings = brute_force_.meetings(prepared);
  ++tally.rays;
  std::string wrong;
  const auto complain = [&](const std::string& what) {
    if (wrong.empty()) wrong = what;
  };
  if (!meetings.empty()) path_.start(prepared);
  for (const Meeting& m : meetings) {
    if (!m.exact) {
      ++tally.near_misses;
      continue;
    }
    ++tally.exact_hits;
    const std::uint32_t primitive = scene_.bvh.triangles[m.triangle].primitive;
    LaneRef rejected;
    if (!path_.reaches(m.triangle, rejected)) {
      ++tally.lost;
      complain(fmt::format("primitive {} is met exactly, and lane {} of node {} on the way to it is rejected",
                           primitive, rejected.lane, rejected.node));
    } else if (!m.accepted) {
      ++tally.declined;
    } else if (accounts_for(ray, answer, m)) {
      ++tally.kept;
    } else if (answer.primitive != intersect::kNoPrimitive && !is_met_by(ray, answer.t, m.triangle)) {
      ++tally.misplaced;
    } else {
      ++tally.lost;
      complain(fmt::format("primitive {} is met at t = {:a}, and the answer is {}", primitive, m.t,
                           answer.primitive == intersect::kNoPrimitive
                               ? "no hit"
                               : fmt::format("primitive {} at {:a}", answer.primitive, answer.t)));
    }
  }
  tally.ties += nearest_exact(meetings) > 1;
  if (!is_some_triangles(prepared, answer, meetings)) {
    ++tally.invented;
    complain(fmt::format("primitive {} does not answer t = {:a}, u = {:a}, v = {:a}", answer.primitive, answer.t,
                         answer.u, answer.v));
  }
  return wrong;
}

Hit Judge::true_hit(const Ray& ray) {
  Hit best;
  best.t = ray.tmax;
  const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
  for (const Meeting& m : brute_force_.meetings(prepared)) {
    const accel::LeafTriangle& t = scene_.bvh.triangles[m.triangle];
    if (!m.exact || !m.accepted || !intersect::replaces(m.t, t.primitive, best)) continue;
    const auto result = intersect::triangle_test(prepared, t.v0, t.v1, t.v2, ray.tmax);
    best = {result.t, result.u, result.v, t.primitive};
  }
  return best;
}

void Judge::finish(Tally& tally) const {
  path_.add_lanes(tally);
  tally.oracle += brute_force_.counts();
}

}  // namespace ctu::sim::check
