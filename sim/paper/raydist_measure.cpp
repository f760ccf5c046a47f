#include "sim/paper/raydist_measure.h"

#include <algorithm>
#include <bit>

#include "model/accel/statistics.h"
#include "model/influence/projected_area.h"
#include "model/reference/traversal.h"
#include "model/scene/random.h"
#include "sim/selection_survey.h"
#include "sim/stopwatch.h"
#include "traces/ray_generator.h"

namespace ctu::sim::paper {
namespace {

using influence::AreaKind;
using influence::InfluenceArea;
using influence::TreeAxes;
using influence::TreeCost;
using intersect::Hit;
using intersect::Ray;
using Rays = std::vector<Ray>;

constexpr double kAffineCosine = 0.996;              // 5 degrees
constexpr std::uint32_t kAffineStream = 0x61666669;  // random numbers of their own

/// Rays from end to end of the area, uniform over its cross-section.
Rays affine_rays(const InfluenceArea& area, std::uint64_t count, std::uint64_t seed) {
  const auto point = [&](double x, double y, double z) {
    const double scale = area.kind == AreaKind::Point ? z : 1;
    const scene::Vector64 u(area.axes[0]), v(area.axes[1]), w(area.axes[2]);
    return scene::Vector64(area.origin) + u * (x * area.half_x * scale) + v * (y * area.half_y * scale) + w * z;
  };
  Rays rays;
  for (std::uint64_t i = 0; i < count; ++i) {
    scene::Random random(seed, i, kAffineStream);
    const double x = random.between(-1, 1), y = random.between(-1, 1);
    const Vec3 from = point(x, y, area.far).rounded();
    const scene::Vector64 way = point(x, y, area.near) - scene::Vector64(from);
    rays.push_back({from, 0, way.rounded(), 1, intersect::RayKind::ClosestHit});
  }
  return rays;
}

/// What all boxes on the way cost, hits or no hits: the number that a heuristic predicts.
std::uint64_t all_on_the_way(const accel::Bvh4& bvh, const Ray& ray) {
  const intersect::PreparedRay prepared = intersect::prepare_ray(ray);
  std::uint64_t work = 0;
  std::vector<accel::ChildRef> open{0};
  while (!open.empty()) {
    const accel::ChildRef ref = open.back();
    open.pop_back();
    if (accel::is_leaf(ref)) {
      work += static_cast<std::uint64_t>(accel::leaf_count(ref));
      continue;
    }
    ++work;
    const accel::Node4& node = bvh.nodes[ref];
    intersect::SlabTimes times;
    intersect::slab_test_outer(prepared, node.boxes, ray.tmax, times);
    for (unsigned lanes = times.hit; lanes != 0; lanes &= lanes - 1)
      open.push_back(node.child[std::countr_zero(lanes)]);
  }
  return work;
}

double mean_on_the_way(const accel::Bvh4& bvh, const Rays& rays) {
  std::uint64_t sum = 0;
  for (const Ray& ray : rays) sum += all_on_the_way(bvh, ray);
  return double(sum) / double(rays.size());
}

/// The work of a ray by the traversal, up to its answer.
double mean_work(const accel::Bvh4& bvh, const Rays& rays) {
  const cull::MaskTester no_culling(cull::Design::None, {});
  const reference::Traversal traversal(bvh, nullptr, no_culling);
  reference::StepList steps;
  for (const Ray& ray : rays) traversal.trace(ray, &steps);
  return reference::count_steps(steps, 0, steps.rays()).intersections_per_ray();
}

Rays shadow_rays(const scene::Scene& scene, const accel::Bvh4& global, const TestLight& light,
                 traces::RayOptions options, std::uint64_t most) {
  options.kind = traces::RayOptions::Rays::Shadow;
  options.light = light.place;
  const traces::RayGenerator generator(scene, options);
  const cull::MaskTester no_culling(cull::Design::None, {});
  const reference::Traversal traversal(global, nullptr, no_culling);
  Rays rays;
  std::vector<Hit> hits;
  generator.generate(
      0, generator.paths(), [&](const Ray& ray, bool) { return traversal.trace(ray); }, rays, hits);
  if (rays.size() <= most) return rays;
  Rays some;
  for (std::uint64_t i = 0; i < most; ++i) some.push_back(rays[i * rays.size() / most]);
  return some;
}

HeuristicResult measure_heuristic(const scene::Mesh& mesh, const std::vector<std::uint32_t>& triangles,
                                  const InfluenceArea& area, const influence::TreeHeuristic& heuristic,
                                  const accel::BuildOptions& build, const Rays& affine, const Rays& shadow) {
  HeuristicResult result;
  const ThreadStopwatch watch;
  const accel::Bvh4 bvh = influence::build_for(mesh, triangles, area, heuristic, build);
  result.build_seconds = watch.seconds();
  result.depth = bvh.depth;
  const double root = accel::surface_area(bvh.lower, bvh.upper);
  result.surface_predicted = accel::expected_work(bvh, [&](const Vec3& lower, const Vec3& upper) {
                               return root > 0 ? accel::surface_area(lower, upper) / root : 0;
                             }).intersections();
  const influence::ProjectedArea projected(area);
  result.projected_predicted = accel::expected_work(bvh, [&](const Vec3& lower, const Vec3& upper) {
                                 return projected.share(lower, upper);
                               }).intersections();
  result.crossing = mean_on_the_way(bvh, affine);
  result.closest = mean_work(bvh, affine);
  result.shadow = mean_work(bvh, shadow);
  return result;
}

/// Rays of the sample that are affine to the area and lie in it.
Rays rays_in(const influence::PreparedArea& area, const Rays& rays, double least_cosine) {
  Rays inside;
  for (const Ray& ray : rays)
    if (influence::runs_along(area.area(), ray, least_cosine) && area.certainly_contains(ray.origin))
      inside.push_back(ray);
  return inside;
}

SelectionResult measure_selection(const scene::Scene& scene, const influence::TreeSet& trees, const Rays& shadow) {
  const SelectionSurvey survey = survey_selection(scene.mesh, trees, shadow);
  SelectionResult result;
  result.rays = survey.record.rays;
  result.affine = survey.record.affine;
  result.final = survey.record.final;
  result.global_cost = survey.alone.intersections_per_ray();
  result.local_cost = survey.record.local_counts().intersections_per_ray();
  result.selecting_cost = survey.selecting_cost();
  result.memory_ratio = trees.memory_ratio();
  result.changed = survey.changed;
  result.lost = survey.lost;
  return result;
}

}  // namespace

const std::vector<NamedHeuristic>& compared_heuristics() {
  using influence::FacingThresholds;
  using influence::kStrictThresholds;
  static const std::vector<NamedHeuristic> all = {
      {"LSPH + SAH", {TreeCost::SurfaceArea, TreeAxes::Longest}},
      {"all axes + SAH", {TreeCost::SurfaceArea, TreeAxes::All}},
      {"SPFH + SAH", {TreeCost::SurfaceArea, TreeAxes::LeastFacing, FacingThresholds{}}, true},
      {"SPFH strict + SAH", {TreeCost::SurfaceArea, TreeAxes::LeastFacing, kStrictThresholds}},
      {"LSPH + PAH", {TreeCost::ProjectedArea, TreeAxes::Longest}, true},
      {"all axes + PAH", {TreeCost::ProjectedArea, TreeAxes::All}, true},
      {"SPFH + PAH", {TreeCost::ProjectedArea, TreeAxes::LeastFacing, FacingThresholds{}}, true},
      {"SPFH strict + PAH", {TreeCost::ProjectedArea, TreeAxes::LeastFacing, kStrictThresholds}},
      {"all axes + mixed, 1/50", {TreeCost::Mixed, TreeAxes::All, {}, 0.02}},
      {"all axes + mixed, 1/10", {TreeCost::Mixed, TreeAxes::All, {}, 0.1}},
      {"all axes + mixed, 1/4", influence::kLocalHeuristic, true},
  };
  return all;
}

std::size_t chosen_heuristic() { return 10; }

LightResult measure_light(const scene::Scene& scene, const accel::Bvh4& global, const TestLight& light,
                          const RayDistributionOptions& options) {
  LightResult result;
  result.light = light;
  const Rays shadow = shadow_rays(scene, global, light, options.rays, options.most_shadow_rays);
  result.shadow_rays = shadow.size();
  const influence::FoundAreas found = influence::find_areas(shadow, scene.lower, scene.upper);
  result.areas = found.areas.size();
  result.looked_at = found.looked_at;
  result.claimed = found.looked_at - found.unclaimed;
  if (found.areas.empty()) return result;

  const auto largest = std::max_element(found.areas.begin(), found.areas.end(),
                                        [](const auto& a, const auto& b) { return a.rays < b.rays; });
  const influence::PreparedArea area(largest->area);
  result.found_kind = largest->area.kind;
  const std::vector<std::uint32_t> triangles = influence::primitives_in(scene.mesh, area, 1);
  result.local_triangles = triangles.size();
  if (triangles.empty()) return result;
  const Rays affine = affine_rays(largest->area, options.affine_rays, options.rays.seed);
  const Rays inside = rays_in(area, shadow, kAffineCosine);
  for (const NamedHeuristic& compared : compared_heuristics())
    result.heuristics.push_back(
        measure_heuristic(scene.mesh, triangles, largest->area, compared.heuristic, options.build, affine, inside));

  influence::TreeSetOptions set;
  set.build = options.build;
  set.local = compared_heuristics()[chosen_heuristic()].heuristic;
  result.selection = measure_selection(scene, influence::TreeSet(scene.mesh, global, found.list(), set), shadow);
  return result;
}

}  // namespace ctu::sim::paper
