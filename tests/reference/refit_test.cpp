// Culling after a refit: the moved scene is hit as it is without culling, and as a new tree over it is.
#include <gtest/gtest.h>

#include <algorithm>

#include "model/accel/build.h"
#include "model/accel/refit.h"
#include "model/cull/refit_masks.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/seed.h"
#include "tests/reference/rays.h"
#include "tests/support/motions.h"

namespace {

using namespace ctu;
using cull::Design;
using intersect::Hit;
using intersect::Ray;
using test::Motion;

/// A scene whose vertices have moved, with a tree and masks that have followed them.
struct Refitted {
  scene::Scene scene;
  accel::Bvh4 tree;
  cull::ObjectMasks masks;

  Refitted(const std::string& name, Motion motion, const cull::MaskOptions& options) : scene(scene::load(name)) {
    tree = accel::build(scene.mesh, {});
    masks = cull::build_object_masks(tree, options, 2);
    scene.mesh = test::moved(scene.mesh, motion, oracle::test_seed());
    cull::refit_object_masks(masks, tree, accel::refit(tree, scene.mesh, 2), options, 2);
    scene.lower = tree.lower;
    scene.upper = tree.upper;
  }
};

bool is_true_hit(const scene::Mesh& mesh, const Ray& ray, std::uint32_t primitive) {
  if (primitive == intersect::kNoPrimitive) return false;
  const auto& [a, b, c] = mesh.triangles[primitive];
  const auto& v = mesh.vertices;
  return oracle::exact_ray_triangle(ray, v[a], v[b], v[c], ray.tmin, ray.tmax).hit;
}

/// A hit may differ only where the rounded triangle test alone accepted a ray that exactly misses the triangle.
void expect_same_hits(const Refitted& world, const std::vector<Ray>& rays, const cull::MaskOptions& options) {
  const cull::MaskTester none(Design::None, {});
  const accel::Bvh4 rebuilt = accel::build(world.scene.mesh, {});
  const reference::Traversal plain(world.tree, nullptr, none), anew(rebuilt, nullptr, none);
  std::vector<Hit> expected;
  std::size_t hits = 0;
  for (const Ray& ray : rays) {
    expected.push_back(plain.trace(ray));
    const Hit fresh = anew.trace(ray);
    hits += fresh.primitive != intersect::kNoPrimitive;
    if (!same_bits(expected.back(), fresh)) {
      EXPECT_FALSE(is_true_hit(world.scene.mesh, ray, fresh.primitive)) << "new tree, primitive " << fresh.primitive;
    }
  }
  EXPECT_GT(hits, rays.size() / 20);
  for (const Design design : {Design::Ideal, Design::MaskLut, Design::Projection, Design::Comparators}) {
    const cull::MaskTester tester(design, options);
    const reference::Traversal culled(world.tree, &world.masks, tester);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit found = culled.trace(rays[i]);
      if (same_bits(found, expected[i])) continue;
      EXPECT_FALSE(is_true_hit(world.scene.mesh, rays[i], expected[i].primitive))
          << to_string(design) << ", ray " << i << " lost primitive " << expected[i].primitive;
    }
  }
}

class CullingAfterARefit : public testing::TestWithParam<Motion> {};

TEST_P(CullingAfterARefit, keeps_every_true_hit) {
  SCOPED_TRACE(oracle::seed_note());
  for (const char* name : {"gen:hair-ball?strands=300", "gen:tilted-quads?quads=600", "gen:tetra"})
    for (const int levels : {cull::kUnlimitedLevels, 1, 3}) {
      SCOPED_TRACE(std::string(name) + ", L " + std::to_string(levels));
      const cull::MaskOptions options{.resolution = 4, .ray_resolution = 5, .levels = levels};
      const Refitted world(name, GetParam(), options);
      const int count = GetParam() == Motion::Reorder ? 200 : 1000;  // its triangles cross the whole scene
      std::vector<Ray> rays = test::random_rays(world.scene, count, oracle::test_seed());
      const std::vector<Ray> aimed = test::aimed_rays(world.scene, count, oracle::test_seed());
      rays.insert(rays.end(), aimed.begin(), aimed.end());
      expect_same_hits(world, rays, options);
    }
}

INSTANTIATE_TEST_SUITE_P(Motions, CullingAfterARefit,
                         testing::Values(Motion::OneVertex, Motion::Dent, Motion::Scattered, Motion::Twist,
                                         Motion::Degenerate, Motion::Reorder),
                         [](const auto& info) {
                           std::string name = test::to_string(info.param);
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

}  // namespace
