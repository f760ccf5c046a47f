// Local trees change the work and no answer: bit for bit what the global tree alone says, for rays of every kind, in
// and around areas that were found from shadow rays.
#include "model/reference/selecting_traversal.h"

#include <gtest/gtest.h>

#include <limits>

#include "model/accel/build.h"
#include "model/influence/find_areas.h"
#include "model/intersect/triangle_test.h"
#include "model/scene/load.h"
#include "model/scene/random.h"
#include "tests/oracle/seed.h"
#include "traces/ray_generator.h"

namespace ctu {
namespace {

using influence::InfluenceArea;
using influence::TreeAxes;
using influence::TreeCost;
using influence::TreeHeuristic;
using influence::TreeSet;
using intersect::Hit;
using intersect::Ray;
using traces::RayOptions;

class Plain {
 public:
  explicit Plain(const accel::Bvh4& bvh) : tester_(cull::Design::None, {}), traversal_(bvh, nullptr, tester_) {}
  Hit trace(const Ray& ray) const { return traversal_.trace(ray); }

 private:
  cull::MaskTester tester_;
  reference::Traversal traversal_;
};

std::vector<Ray> rays_of(const scene::Scene& scene, const Plain& plain, RayOptions::Rays kind) {
  RayOptions options;
  options.kind = kind;
  options.width = 48;
  options.height = 32;
  options.bounces = 1;
  options.seed = oracle::test_seed();
  const traces::RayGenerator generator(scene, options);
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  generator.generate(
      0, generator.paths(), [&](const Ray& ray, bool) { return plain.trace(ray); }, rays, hits);
  return rays;
}

/// From points of random triangles, a little above them, to the light: what next-event estimation sends.
std::vector<Ray> shadow_rays(const scene::Scene& scene, const Vec3& light, int count, std::uint64_t seed) {
  using scene::Vector64;
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    scene::Random random(seed, static_cast<std::uint64_t>(i));
    const auto& [a, b, c] =
        scene.mesh.triangles[static_cast<std::size_t>(random.unit() * double(scene.mesh.triangles.size()))];
    const Vector64 v0(scene.mesh.vertices[a]), v1(scene.mesh.vertices[b]), v2(scene.mesh.vertices[c]);
    const double u = random.unit(), v = (1 - u) * random.unit();
    const Vector64 on = v0 * (1 - u - v) + v1 * u + v2 * v;
    const Vector64 from = on + normalized(Vector64(light) - on, {0, 0, 1}) * (1e-4 * length(on));
    const Vector64 way = Vector64(light) - Vector64(from.rounded());
    rays.push_back({from.rounded(), 0, normalized(way, {0, 0, 1}).rounded(),
                    static_cast<float>(length(way) * (1 - 0x1p-20)), intersect::RayKind::AnyHit});
  }
  return rays;
}

/// The part of the area near its beginning: rays leave it with their answer beyond.
InfluenceArea cut_short(InfluenceArea area) {
  area.far = area.near + 0.6f * (area.far - area.near);
  area.half_x *= 0.8f;
  return area;
}

/// Lights inside and outside of the scene, one so far away that its rays are parallel.
std::vector<Vec3> lights(const scene::Scene& scene) {
  const auto at = [&](float x, float y, float z, float diagonals) {
    const Vec3 size{scene.upper.x - scene.lower.x, scene.upper.y - scene.lower.y, scene.upper.z - scene.lower.z};
    return Vec3{0.5f * (scene.lower.x + scene.upper.x) + x * diagonals * size.x,
                0.5f * (scene.lower.y + scene.upper.y) + y * diagonals * size.y,
                0.5f * (scene.lower.z + scene.upper.z) + z * diagonals * size.z};
  };
  return {at(0, 0, 1, 1.5f), at(0.3f, -0.2f, 0.1f, 1), at(0.6f, 0.3f, 0.7f, 1000)};
}

/// The same ray with an end, without one, and turned round: what the areas were not made for.
std::vector<Ray> variants(const Ray& ray) {
  Ray closest = ray, endless = ray, reverse = ray;
  closest.kind = intersect::RayKind::ClosestHit;
  endless.kind = intersect::RayKind::ClosestHit;
  endless.tmax = std::numeric_limits<float>::infinity();
  reverse.kind = intersect::RayKind::ClosestHit;
  reverse.direction = {-ray.direction.x, -ray.direction.y, -ray.direction.z};
  reverse.tmin = 0.01f;  // past the triangle it starts on
  return {ray, closest, endless, reverse};
}

void expect_same_answer(const scene::Scene& scene, const Plain& plain, const reference::SelectingTraversal& selecting,
                        const Ray& ray, reference::SelectionRecord& record) {
  const Hit expected = plain.trace(ray), found = selecting.trace(ray, &record);
  if (ray.kind == intersect::RayKind::ClosestHit) {
    ASSERT_TRUE(intersect::same_bits(expected, found)) << "expected " << expected.primitive << " at " << expected.t
                                                       << ", found " << found.primitive << " at " << found.t;
    return;
  }
  ASSERT_EQ(expected.primitive == intersect::kNoPrimitive, found.primitive == intersect::kNoPrimitive);
  if (found.primitive == intersect::kNoPrimitive) return;
  const auto& [a, b, c] = scene.mesh.triangles[found.primitive];
  const auto own = intersect::triangle_test(intersect::prepare_ray(ray), scene.mesh.vertices[a], scene.mesh.vertices[b],
                                            scene.mesh.vertices[c], ray.tmax);
  EXPECT_TRUE(own.hit && intersect::same_bits(found, {own.t, own.u, own.v, found.primitive}));
}

class SelectingTraversal : public testing::TestWithParam<const char*> {};

TEST_P(SelectingTraversal, answers_as_the_global_tree_bit_for_bit) {
  SCOPED_TRACE(oracle::seed_note());
  const scene::Scene scene = scene::load(GetParam());
  const accel::Bvh4 global = accel::build(scene.mesh, {});
  const Plain plain(global);
  std::vector<Ray> others = rays_of(scene, plain, RayOptions::Rays::Diffuse);
  const std::vector<Ray> random = rays_of(scene, plain, RayOptions::Rays::Random);
  others.insert(others.end(), random.begin(), random.end());

  const TreeHeuristic heuristics[] = {{TreeCost::SurfaceArea, TreeAxes::LeastFacing},
                                      {TreeCost::ProjectedArea, TreeAxes::LeastFacing},
                                      {TreeCost::ProjectedArea, TreeAxes::All}};
  std::size_t next = 0;
  for (const Vec3& light : lights(scene)) {
    SCOPED_TRACE("light " + std::to_string(next));
    const std::vector<Ray> shadow = shadow_rays(scene, light, 600, oracle::test_seed() + next);
    const std::vector<InfluenceArea> areas = influence::find_areas(shadow, scene.lower, scene.upper).list();
    influence::TreeSetOptions options;
    options.local = heuristics[next++ % 3];
    const TreeSet trees(scene.mesh, global, areas, options);
    ASSERT_FALSE(trees.areas().empty());
    const reference::SelectingTraversal selecting(trees);
    reference::SelectionRecord of_shadow_rays;
    for (const Ray& ray : shadow) expect_same_answer(scene, plain, selecting, ray, of_shadow_rays);
    EXPECT_GT(of_shadow_rays.final, 9 * of_shadow_rays.rays / 10) << "the areas are those of these rays";
    EXPECT_EQ(of_shadow_rays.local.rays(), of_shadow_rays.affine);
    EXPECT_EQ(of_shadow_rays.global.rays(), of_shadow_rays.rays - of_shadow_rays.final);

    std::vector<InfluenceArea> parts;
    for (const InfluenceArea& area : areas) parts.push_back(cut_short(area));
    const TreeSet part_trees(scene.mesh, global, parts, options);
    const reference::SelectingTraversal in_parts(part_trees);
    reference::SelectionRecord record;
    for (const Ray& ray : shadow)
      for (const Ray& variant : variants(ray)) {
        expect_same_answer(scene, plain, selecting, variant, record);
        expect_same_answer(scene, plain, in_parts, variant, record);
      }
    for (const Ray& ray : others) expect_same_answer(scene, plain, in_parts, ray, record);
    EXPECT_GT(record.rays, record.affine) << "some rays are affine to no area";
    EXPECT_GT(record.affine, record.final) << "some leave their area without an answer";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SelectingTraversal,
                         testing::Values("gen:hair-ball?strands=300", "gen:curly-hair?strands=100",
                                         "gen:straight-hair?strands=300", "gen:tilted-quads?quads=1000",
                                         "gen:foliage?twigs=60", "gen:tetra?depth=4"));

TEST(SelectingTraversalRules, rays_that_are_not_valid_or_begin_behind_their_origin_walk_the_global_tree) {
  const scene::Scene scene = scene::load("gen:tetra?depth=3");
  const accel::Bvh4 global = accel::build(scene.mesh, {});
  influence::InfluenceArea area;
  area.axes = influence::frame_along({0, 0, 1}, {1, 0, 0});
  area.half_x = area.half_y = area.far = 100;
  area.near = -100;
  const TreeSet trees(scene.mesh, global, {area}, {});
  const reference::SelectingTraversal selecting(trees);
  const Ray good{{0.1f, 0.1f, 5}, 0, {0, 0, -1}, 50};
  reference::SelectionRecord record;
  selecting.trace(good, &record);
  EXPECT_EQ(record.affine, 1u);
  Ray behind = good, none = good;
  behind.tmin = -1;
  none.direction = {0, 0, 0};
  selecting.trace(behind, &record);
  selecting.trace(none, &record);
  EXPECT_EQ(record.affine, 1u);
  EXPECT_EQ(record.global.rays(), 2u);
}

TEST(SelectingTraversalRules, without_areas_is_the_plain_walk_step_for_step) {
  const scene::Scene scene = scene::load("gen:hair-ball?strands=50");
  const accel::Bvh4 global = accel::build(scene.mesh, {});
  const TreeSet trees(scene.mesh, global, {}, {});
  const reference::SelectingTraversal selecting(trees);
  const cull::MaskTester no_culling(cull::Design::None, {});
  const reference::Traversal traversal(global, nullptr, no_culling);
  reference::SelectionRecord record;
  reference::StepList steps;
  for (const Ray& ray : rays_of(scene, Plain(global), RayOptions::Rays::Primary)) {
    traversal.trace(ray, &steps);
    selecting.trace(ray, &record);
  }
  EXPECT_EQ(record.global.steps, steps.steps);
  EXPECT_EQ(record.areas_asked, 0u);
  EXPECT_EQ(trees.memory_ratio(), 1);
}

}  // namespace
}  // namespace ctu
