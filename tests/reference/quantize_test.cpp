// Trees with boxes of reduced precision, walked with and without culling: the hits are those of binary32 boxes, but for
// near-misses: triangles that the exact ray misses and the rounded triangle test accepts, which any box may take away.
#include "model/accel/quantize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "model/accel/build.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/oracle/exact_triangle.h"
#include "tests/oracle/seed.h"

namespace ctu {
namespace {

using cull::Design;
using intersect::Hit;
using intersect::Ray;

constexpr int kRays = 1500;

struct Case {
  const char* name;
  const char* scene;
  float scale = 1, offset = 0;  ///< of the coordinates
  cull::MaskOptions masks = {};
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class QuantizedTree : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    mesh_ = scene::load(GetParam().scene).mesh;
    for (Vec3& v : mesh_.vertices)
      for (int axis = 0; axis < 3; ++axis) v[axis] = v[axis] * GetParam().scale + GetParam().offset;
    tree_ = accel::build(mesh_, {});
  }

  /// Half of them between points of the scene's box, half aimed at vertices from far away.
  std::vector<Ray> rays() const {
    std::mt19937_64 random(oracle::test_seed());
    const auto point = [&](float margin) {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        const float size = tree_.upper[axis] - tree_.lower[axis];
        p[axis] = std::uniform_real_distribution<float>(tree_.lower[axis] - margin * size,
                                                        tree_.upper[axis] + margin * size)(random);
      }
      return p;
    };
    std::vector<Ray> rays;
    for (int i = 0; i < kRays; ++i) {
      const Vec3 from = point(i % 2 == 0 ? 0.5f : 20.0f);
      const Vec3 to = i % 2 == 0 ? point(0) : mesh_.vertices[random() % mesh_.vertices.size()];
      rays.push_back({from,
                      0,
                      {to.x - from.x, to.y - from.y, to.z - from.z},
                      i % 5 == 0 ? 1.0f : std::numeric_limits<float>::infinity()});
    }
    return rays;
  }

  bool misses_exactly(const Ray& ray, std::uint32_t primitive) const {
    const auto& t = mesh_.triangles[primitive];
    return !oracle::exact_ray_triangle(ray, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]], ray.tmin,
                                       ray.tmax)
                .hit;
  }

  /// Whether hits may differ: the one that comes first is of a triangle that the exact ray misses.
  bool differ_by_a_near_miss(const Ray& ray, const Hit& a, const Hit& b) const {
    const bool a_first = a.primitive != intersect::kNoPrimitive &&
                         (b.primitive == intersect::kNoPrimitive || intersect::replaces(a.t, a.primitive, b));
    const Hit& first = a_first ? a : b;
    return first.primitive != intersect::kNoPrimitive && misses_exactly(ray, first.primitive);
  }

  scene::Mesh mesh_;
  accel::Bvh4 tree_;
};

TEST_P(QuantizedTree, gives_the_hits_of_binary32_boxes_for_more_intersections) {
  SCOPED_TRACE(oracle::seed_note());
  const std::vector<Ray> rays = this->rays();
  const cull::MaskTester no_culling(Design::None, GetParam().masks);
  std::vector<Hit> expected;
  reference::StepList full;
  {
    const reference::Traversal traversal(tree_, nullptr, no_culling);
    for (const Ray& ray : rays) expected.push_back(traversal.trace(ray, &full));
  }
  std::uint64_t work = reference::count_steps(full, 0, full.rays()).box_hits;
  for (const std::uint32_t bits : {16u, 12u, 8u}) {
    accel::Bvh4 tree = tree_;
    accel::quantize_boxes(tree, bits, 2);
    const cull::ObjectMasks masks = cull::build_object_masks(tree, GetParam().masks, 2);
    for (const Design design : {Design::None, Design::Projection, Design::Comparators}) {
      SCOPED_TRACE(std::to_string(bits) + " bits, " + std::string(to_string(design)));
      const cull::MaskTester tester(design, GetParam().masks);
      const reference::Traversal traversal(tree, &masks, tester);
      reference::StepList steps;
      int near_misses = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit hit = traversal.trace(rays[i], &steps);
        if (intersect::same_bits(hit, expected[i])) continue;
        ASSERT_TRUE(differ_by_a_near_miss(rays[i], expected[i], hit))
            << "ray " << i << ": primitive " << expected[i].primitive << " at " << expected[i].t << " became "
            << hit.primitive << " at " << hit.t;
        ++near_misses;
      }
      EXPECT_LE(near_misses, kRays / 20);
      if (design != Design::None) continue;
      const std::uint64_t hits = reference::count_steps(steps, 0, steps.rays()).box_hits;
      EXPECT_GE(hits, work);
      work = hits;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, QuantizedTree,
                         testing::Values(Case{"hair", "gen:hair-ball?strands=300"},
                                         Case{"hair_levels_2", "gen:hair-ball?strands=300", 1, 0, {.levels = 2}},
                                         Case{"foliage_r6", "gen:foliage?twigs=40", 1, 0, {6, 6}},
                                         Case{"quads", "gen:tilted-quads?quads=1000"},
                                         Case{"hair_far_away", "gen:hair-ball?strands=200", 1, 1e4f},
                                         Case{"huge_hair", "gen:hair-ball?strands=100", 1e30f},
                                         Case{"tiny_hair", "gen:hair-ball?strands=100", 1e-20f}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace ctu
