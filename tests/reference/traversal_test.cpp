// The reference traversal against brute force, and the laws of its event sequence.
#include "model/reference/traversal.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <map>
#include <random>

#include "model/accel/build.h"
#include "model/intersect/triangle_test.h"
#include "model/scene/load.h"
#include "tests/oracle/seed.h"

namespace {

using namespace ctu;
using cull::Design;
using intersect::Hit;
using intersect::Ray;
using reference::Step;
using reference::StepList;

struct World {
  scene::Scene scene;
  accel::Bvh4 bvh;
  cull::ObjectMasks masks;
  explicit World(const std::string& name, const cull::MaskOptions& options = {})
      : scene(scene::load(name)), bvh(accel::build(scene.mesh, {})), masks(cull::build_object_masks(bvh, options, 2)) {}
};

Vec3 on_a_triangle(const scene::Mesh& mesh, std::mt19937_64& random) {
  const auto& t = mesh.triangles[std::uniform_int_distribution<std::size_t>(0, mesh.triangles.size() - 1)(random)];
  const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
}

/// Rays from around the scene; every second one aims at the middle of a triangle.
std::vector<Ray> random_rays(const scene::Scene& scene, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto point = [&] {
    Vec3 p;
    for (int a = 0; a < 3; ++a) {
      const float margin = 0.3f * (scene.upper[a] - scene.lower[a]);
      p[a] = std::uniform_real_distribution<float>(scene.lower[a] - margin, scene.upper[a] + margin)(random);
    }
    return p;
  };
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 a = point(), b = i % 2 == 0 ? point() : on_a_triangle(scene.mesh, random);
    rays.push_back({a,
                    0.0f,
                    {b.x - a.x, b.y - a.y, b.z - a.z},
                    std::numeric_limits<float>::infinity(),
                    i % 4 == 3 ? intersect::RayKind::AnyHit : intersect::RayKind::ClosestHit});
  }
  return rays;
}

Hit brute_force(const accel::Bvh4& bvh, const Ray& ray) {
  const auto prepared = intersect::prepare_ray(ray);
  Hit best;
  best.t = ray.tmax;
  for (const auto& triangle : bvh.triangles) {
    const auto result = intersect::triangle_test(prepared, triangle.v0, triangle.v1, triangle.v2, best.t);
    if (result.hit && intersect::replaces(result.t, triangle.primitive, best))
      best = {result.t, result.u, result.v, triangle.primitive};
  }
  return best;
}

TEST(TraversalTest, closest_hits_are_those_of_brute_force) {
  const std::uint64_t seed = oracle::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  for (const char* name : {"gen:hair-ball?strands=150", "gen:tilted-quads", "gen:tetra"}) {
    const World world(name);
    const cull::MaskTester none(Design::None, {});
    const reference::Traversal traversal(world.bvh, nullptr, none);
    int hits = 0;
    for (const Ray& ray : random_rays(world.scene, 400, seed)) {
      const Hit expected = brute_force(world.bvh, ray), found = traversal.trace(ray);
      if (ray.kind == intersect::RayKind::AnyHit) {
        EXPECT_EQ(found.primitive == intersect::kNoPrimitive, expected.primitive == intersect::kNoPrimitive) << name;
      } else {
        EXPECT_TRUE(intersect::same_bits(found, expected)) << name << " t " << found.t << " expected " << expected.t;
      }
      hits += expected.primitive != intersect::kNoPrimitive;
    }
    EXPECT_GT(hits, 150) << name;
  }
}

/// What the stack must hold, rebuilt from the recorded outcomes alone.
void expect_sequence_follows_from_its_outcomes(const accel::Bvh4& bvh, const StepList& list, std::uint64_t ray) {
  std::vector<accel::ChildRef> stack{0};
  for (std::uint64_t i = list.first_step[ray]; i < list.first_step[ray + 1]; ++i) {
    const Step& step = list.steps[i];
    ASSERT_GT(stack.size(), step.dropped) << "ray " << ray;
    stack.resize(stack.size() - step.dropped);
    ASSERT_EQ(stack.back(), step.ref) << "ray " << ray;
    stack.pop_back();
    if (step.is_leaf()) {
      EXPECT_EQ(step.triangles_tested(), accel::leaf_count(step.ref));
      continue;
    }
    EXPECT_EQ(step.survivors() & ~step.box_hits(), 0u);
    EXPECT_EQ(step.uncertain() & ~step.survivors(), 0u);
    const int survivors = std::popcount(step.survivors());
    unsigned visited = 0;
    for (int position = survivors - 1; position >= 0; --position) {
      visited |= 1u << step.survivor(position);
      stack.push_back(bvh.nodes[step.ref].child[step.survivor(position)]);
    }
    EXPECT_EQ(visited, step.survivors());
  }
}

TEST(TraversalTest, event_sequences_follow_from_their_outcomes_and_cost_never_rises_with_culling) {
  const std::uint64_t seed = oracle::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  const World world("gen:hair-ball?strands=300");
  const auto rays = random_rays(world.scene, 2000, seed);
  std::map<Design, StepList> lists;
  std::map<Design, std::vector<Hit>> hits;
  for (const Design design : {Design::None, Design::Ideal, Design::MaskLut, Design::Projection, Design::Comparators}) {
    const cull::MaskTester tester(design, {});
    const reference::Traversal traversal(world.bvh, &world.masks, tester);
    for (const Ray& ray : rays) hits[design].push_back(traversal.trace(ray, &lists[design]));
    for (std::uint64_t i = 0; i < rays.size(); ++i)
      expect_sequence_follows_from_its_outcomes(world.bvh, lists[design], i);
  }
  EXPECT_EQ(lists[Design::MaskLut].steps, lists[Design::Projection].steps);
  EXPECT_EQ(lists[Design::MaskLut].keys, lists[Design::Projection].keys);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].kind == intersect::RayKind::AnyHit) continue;  // may stop at another of its hits
    const auto work = [&](Design design) { return count_steps(lists[design], i, i + 1).intersections(); };
    for (const auto& [design, found] : hits) EXPECT_TRUE(intersect::same_bits(found[i], hits[Design::None][i]));
    EXPECT_LE(work(Design::Ideal), work(Design::Comparators));
    EXPECT_LE(work(Design::Comparators), work(Design::None));
    EXPECT_LE(work(Design::MaskLut), work(Design::None));
  }
  const auto total = [&](Design design) { return count_steps(lists[design], 0, rays.size()).intersections(); };
  EXPECT_LT(total(Design::Comparators), total(Design::MaskLut));
  EXPECT_LT(total(Design::MaskLut), total(Design::None));
}

TEST(TraversalTest, a_ray_that_is_not_accepted_misses_and_visits_nothing) {
  const World world("gen:tetra");
  const cull::MaskTester none(Design::None, {});
  const reference::Traversal traversal(world.bvh, nullptr, none);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Ray good{{5, 0.1f, 0.2f}, 0, {-1, 0, 0}, inf, intersect::RayKind::ClosestHit};
  std::vector<Ray> bad(6, good);
  bad[0].origin.x = nan;
  bad[1].direction.y = inf;
  bad[2].direction = {0, -0.0f, 0};
  bad[3].tmin = nan;
  bad[4].tmax = nan;
  bad[5].tmin = 2, bad[5].tmax = 1;
  for (const Ray& ray : bad) {
    StepList steps;
    EXPECT_EQ(traversal.trace(ray, &steps).primitive, intersect::kNoPrimitive);
    EXPECT_EQ(steps.rays(), 1u);
    EXPECT_TRUE(steps.steps.empty());
  }
}

TEST(TraversalTest, an_any_hit_ray_visits_no_more_than_the_closest_hit_ray) {
  const std::uint64_t seed = oracle::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  const World world("gen:hair-ball?strands=300");
  const cull::MaskTester none(Design::None, {});
  const reference::Traversal traversal(world.bvh, nullptr, none);
  std::uint64_t saved = 0;
  for (Ray ray : random_rays(world.scene, 1000, seed)) {
    StepList any, closest;
    ray.kind = intersect::RayKind::AnyHit;
    const Hit any_hit = traversal.trace(ray, &any);
    ray.kind = intersect::RayKind::ClosestHit;
    const Hit closest_hit = traversal.trace(ray, &closest);
    EXPECT_EQ(any_hit.primitive == intersect::kNoPrimitive, closest_hit.primitive == intersect::kNoPrimitive);
    EXPECT_LE(any.steps.size(), closest.steps.size());
    saved += closest.steps.size() - any.steps.size();
  }
  EXPECT_GT(saved, 0u);
}

}  // namespace
