// Ray-box culling in kd-trees and in the 4-wide tree: the hits of the scene, judged by exact arithmetic where they
// differ from those of every primitive tested by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "model/accel/build.h"
#include "model/accel/leaf_record.h"
#include "model/cull/object_masks.h"
#include "model/numeric/round.h"
#include "model/reference/kd_traversal.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "sim/check/hard_case.h"
#include "sim/hit_judge.h"
#include "tests/cull/epsilon_ray_box.h"
#include "tests/oracle/seed.h"
#include "tests/reference/brute_force.h"
#include "traces/ray_generator.h"

namespace {

using namespace ctu;
using cull::NoRayBox;
using cull::RayBox;
using intersect::Hit;
using intersect::Ray;
using reference::KdCounts;
using test::brute_force;

std::string show(const Ray& ray) {
  std::ostringstream text;
  text << "ray bits" << std::hex;
  for (const float f : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z,
                        ray.tmin, ray.tmax})
    text << " 0x" << numeric::bits(f);
  return text.str();
}

bool loses(const sim::HitJudge& judge, const Ray& ray, const Hit& should, const Hit& is) {
  return !intersect::same_bits(should, is) && judge.judge(ray, should, is) == sim::Verdict::Lost;
}

/// The trees of a mesh: leaf sizes of the paper's kind, clipped and not.
std::vector<accel::KdTree> kd_trees(const scene::Mesh& mesh) {
  std::vector<accel::KdTree> trees;
  for (const int leaf : {1, 4, 32})
    for (const bool clip : {false, true})
      trees.push_back(accel::build_kd_tree(mesh, {.max_leaf_primitives = leaf, .max_depth = 14, .clip = clip}));
  return trees;
}

TEST(KdTraversal, loses_no_true_hit_of_the_hard_cases_with_culling_and_without) {
  SCOPED_TRACE(oracle::seed_note());
  std::uint64_t rays = 0, created = 0, hits = 0;
  for (std::uint32_t generator = 0; generator < sim::check::generators().size(); ++generator) {
    SCOPED_TRACE(sim::check::generators()[generator].name);
    const sim::check::HardCase hard = sim::check::make_case(oracle::test_seed(), generator, 0);
    if (hard.mesh.triangles.size() > 1000) continue;
    const sim::HitJudge judge(hard.mesh);
    KdCounts counts;
    for (const accel::KdTree& tree : kd_trees(hard.mesh))
      for (std::size_t i = 0; i < std::min<std::size_t>(hard.rays.size(), 60); ++i) {
        const Ray& ray = hard.rays[i];
        const Hit should = brute_force(hard.mesh, ray);
        ASSERT_FALSE(loses(judge, ray, should, reference::trace_kd<RayBox>(tree, ray, counts))) << show(ray);
        ASSERT_FALSE(loses(judge, ray, should, reference::trace_kd<NoRayBox>(tree, ray, counts))) << show(ray);
        hits += should.primitive != intersect::kNoPrimitive;
      }
    rays += counts.rays;
    created += counts.leaves.created;
  }
  EXPECT_GT(rays, 5000u);
  EXPECT_GT(created, 2000u);
  EXPECT_GT(hits, rays / 20);
}

/// Camera and shadow rays of a scene.
std::vector<Ray> scene_rays(const scene::Scene& scene, traces::RayOptions::Rays kind, std::uint32_t width) {
  traces::RayOptions options;
  options.kind = kind;
  options.width = options.height = width;
  const traces::RayGenerator generator(scene, options);
  const accel::Bvh4 bvh = accel::build(scene.mesh, {});
  const cull::MaskTester none(cull::Design::None, {});
  const reference::Traversal traversal(bvh, nullptr, none);
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  generator.generate(
      0, generator.paths(), [&](const Ray& ray, bool) { return traversal.trace(ray); }, rays, hits);
  return rays;
}

TEST(KdTraversal, loses_no_true_hit_of_scenes_and_culls_most_tests_of_large_leaves) {
  for (const char* name : {"gen:balls?depth=3", "gen:hair-ball?strands=100", "gen:tilted-quads?quads=500"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = scene::load(name);
    const sim::HitJudge judge(scene.mesh);
    const accel::KdTree tree = accel::build_kd_tree(scene.mesh, {.max_leaf_primitives = 16});
    KdCounts with, without;
    for (const auto kind : {traces::RayOptions::Rays::Diffuse, traces::RayOptions::Rays::Shadow})
      for (const Ray& ray : scene_rays(scene, kind, 24)) {
        const Hit should = reference::trace_kd<NoRayBox>(tree, ray, without);
        const Hit is = reference::trace_kd<RayBox>(tree, ray, with);
        if (ray.kind == intersect::RayKind::AnyHit) {
          if ((is.primitive == intersect::kNoPrimitive) != (should.primitive == intersect::kNoPrimitive)) {
            ASSERT_FALSE(judge.meets(ray, should.primitive)) << show(ray);
          }
          continue;
        }
        ASSERT_FALSE(loses(judge, ray, should, is)) << show(ray);
        ASSERT_FALSE(loses(judge, ray, brute_force(scene.mesh, ray), should)) << show(ray);
      }
    EXPECT_EQ(with.rays, without.rays);
    EXPECT_LT(with.leaves.primitive_tests, without.leaves.primitive_tests / 3);
    EXPECT_EQ(without.leaves.created, 0u);
  }
}

/// Every triangle of its tree in one leaf, whose counts are then those of Algorithm 1 alone.
TEST(KdTraversal, counts_what_it_visits) {
  scene::Mesh mesh;
  for (int i = 0; i < 4; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto z = static_cast<float>(i);
    for (const Vec3& v : {Vec3{-1, -1, z}, Vec3{1, -1, z}, Vec3{0, 1, z}}) mesh.vertices.push_back(v);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const accel::KdTree leaf = accel::build_kd_tree(mesh, {.max_leaf_primitives = 4});
  KdCounts counts;
  const Ray ray{{0, 0, -1}, 0, {0, 0, 1}, 100};
  EXPECT_EQ(reference::trace_kd<RayBox>(leaf, ray, counts).primitive, 0u);
  EXPECT_EQ(counts.traversals(), 1u);
  EXPECT_EQ(counts.leaves.created, 1u);
  EXPECT_EQ(counts.leaves.updated, 1u);
  EXPECT_EQ(counts.leaves.primitive_tests, 1u);  // the hit at z = 0 cuts off the others
  counts = {};
  EXPECT_EQ(reference::trace_kd<NoRayBox>(leaf, ray, counts).primitive, 0u);
  EXPECT_EQ(counts.leaves.primitive_tests, 4u);
  counts = {};
  reference::trace_kd<RayBox>(leaf, {{5, 5, -1}, 0, {0, 0, 1}, 100}, counts);  // past the scene
  EXPECT_EQ(counts.traversals(), 0u);
  EXPECT_EQ(counts.rays, 1u);
}

/// A wall across x = 1000 at the end of a leaf, and a floor before it.
scene::Mesh wall() {
  scene::Mesh mesh;
  const float x = 1000, edge = 0.167f;
  mesh.vertices = {{x, edge, -50}, {x, 50, -50}, {x, 50, 50}, {x, edge, 50}, {x - 100, edge, -50}, {x - 100, 50, -50}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 4}, {1, 4, 5}};
  return mesh;
}

/// Rays from y = -100,000 past the wall's lower edge: o + t d is rounded to multiples of 0.0078 there, 78 of the
/// paper's epsilon, though the wall itself lies near the origin.
TEST(KdTraversal, the_papers_epsilon_loses_hits_from_afar_that_rounding_outward_keeps) {
  const scene::Mesh mesh = wall();
  const sim::HitJudge judge(mesh);
  const accel::KdTree tree = accel::build_kd_tree(mesh, {.max_leaf_primitives = 4});
  int hits = 0, lost = 0;
  std::string first_lost;
  KdCounts counts;
  for (int i = 0; i < 200; ++i)
    for (int k = -100; k < 100; ++k) {
      const Ray ray{{0, -100000 + 0x1p-7f * static_cast<float>(i), 0.1f},
                    0,
                    {1, 100 + 0x1p-17f * static_cast<float>(k), 0.001f},
                    std::numeric_limits<float>::infinity()};
      const Hit should = reference::trace_kd<NoRayBox>(tree, ray, counts);
      hits += should.primitive != intersect::kNoPrimitive;
      ASSERT_FALSE(loses(judge, ray, should, reference::trace_kd<RayBox>(tree, ray, counts))) << show(ray);
      if (loses(judge, ray, should, reference::trace_kd<test::EpsilonRayBox>(tree, ray, counts)) && lost++ == 0)
        first_lost = show(ray);
    }
  EXPECT_GT(hits, 30'000);
  EXPECT_GT(lost, 0);
  RecordProperty("lost", lost);
  RecordProperty("first_lost", first_lost);
}

TEST(RayBoxInTheFourWideTree, loses_no_true_hit_and_composes_with_subspace_culling) {
  const cull::MaskOptions options{.resolution = 4, .ray_resolution = 4};
  for (const char* name : {"gen:balls?depth=3", "gen:hair-ball?strands=100", "gen:tilted-quads?quads=500"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = scene::load(name);
    const sim::HitJudge judge(scene.mesh);
    const accel::Bvh4 bvh = accel::build(scene.mesh, {.max_leaf_triangles = 12, .triangle_cost = 0.01f});
    const cull::ObjectMasks masks = cull::build_object_masks(bvh, options, 1);
    const std::vector<accel::PrimitiveBox> boxes = reference::leaf_boxes(bvh);
    for (const cull::Design design : {cull::Design::None, cull::Design::Comparators}) {
      const cull::MaskTester tester(design, options);
      const cull::ObjectMasks* const used = design == cull::Design::None ? nullptr : &masks;
      const reference::Traversal plain(bvh, used, tester), culled(bvh, used, tester, &boxes);
      reference::StepList plain_steps, culled_steps;
      cull::RayBoxCounts counts, none;
      for (const Ray& ray : scene_rays(scene, traces::RayOptions::Rays::Diffuse, 24)) {
        const Hit should = plain.trace(ray, &plain_steps, nullptr, &none);
        const Hit is = culled.trace(ray, &culled_steps, nullptr, &counts);
        ASSERT_TRUE(intersect::same_bits(is, culled.trace(ray)));
        ASSERT_FALSE(loses(judge, ray, should, is)) << show(ray);
      }
      const auto tests = [](const reference::StepList& steps) {
        return reference::count_steps(steps, 0, steps.rays()).triangle_tests;
      };
      EXPECT_EQ(none.box_tests, 0u);
      EXPECT_EQ(tests(culled_steps), counts.primitive_tests);
      EXPECT_LT(tests(culled_steps), tests(plain_steps));
    }
  }
}

TEST(RayBoxInTheFourWideTree, loses_no_true_hit_of_the_hard_cases) {
  SCOPED_TRACE(oracle::seed_note());
  const cull::MaskTester none(cull::Design::None, {});
  std::uint64_t created = 0;
  for (std::uint32_t generator = 0; generator < sim::check::generators().size(); ++generator) {
    SCOPED_TRACE(sim::check::generators()[generator].name);
    const sim::check::HardCase hard = sim::check::make_case(oracle::test_seed(), generator, 1);
    if (hard.mesh.triangles.size() > 1000) continue;
    const sim::HitJudge judge(hard.mesh);
    const accel::Bvh4 bvh = accel::build(hard.mesh, {.max_leaf_triangles = 15, .triangle_cost = 0.01f});
    const std::vector<accel::PrimitiveBox> boxes = reference::leaf_boxes(bvh);
    const reference::Traversal culled(bvh, nullptr, none, &boxes);
    cull::RayBoxCounts counts;
    for (std::size_t i = 0; i < std::min<std::size_t>(hard.rays.size(), 200); ++i) {
      const Ray& ray = hard.rays[i];
      ASSERT_FALSE(loses(judge, ray, brute_force(hard.mesh, ray), culled.trace(ray, nullptr, nullptr, &counts)))
          << show(ray);
    }
    created += counts.created;
  }
  EXPECT_GT(created, 1000u);
}

}  // namespace
