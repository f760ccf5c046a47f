// Designs with the same masks and keys walk alike: same visits, answers and keys, on the nodes of whole scenes.
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <random>

#include "model/accel/build.h"
#include "model/cull/compress.h"
#include "model/cull/mask_test.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/oracle/seed.h"

namespace ctu {
namespace {

using cull::Design;

struct Case {
  const char* scene;
  cull::MaskOptions options;
};

class DesignsAgree : public testing::TestWithParam<Case> {};

/// Between random points of the scene's bounds, grown by half: some begin inside boxes, some outside.
std::vector<intersect::Ray> random_rays(const scene::Scene& scene, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto point = [&] {
    Vec3 p;
    for (int a = 0; a < 3; ++a) {
      const float margin = 0.5f * (scene.upper[a] - scene.lower[a]);
      p[a] = std::uniform_real_distribution<float>(scene.lower[a] - margin, scene.upper[a] + margin)(random);
    }
    return p;
  };
  std::vector<intersect::Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 a = point(), b = point();
    rays.push_back(
        {a, 0.0f, {b.x - a.x, b.y - a.y, b.z - a.z}, i % 2 == 0 ? 1 : std::numeric_limits<float>::infinity()});
  }
  return rays;
}

struct Walked {
  reference::StepList list;
  std::vector<intersect::Hit> hits;
};

Walked walk(const accel::Bvh4& bvh, const cull::ObjectMasks& masks, const cull::MaskTester& tester,
            const std::vector<intersect::Ray>& rays) {
  const reference::Traversal traversal(bvh, &masks, tester);
  Walked walked;
  for (const intersect::Ray& ray : rays) walked.hits.push_back(traversal.trace(ray, &walked.list));
  return walked;
}

void expect_full_masks_unasked(const accel::Bvh4& bvh, const cull::ObjectMasks& masks,
                               const reference::StepList& list) {
  const std::uint32_t* key = list.keys.data();
  for (const reference::Step& step : list.steps) {
    if (step.is_leaf()) continue;
    ASSERT_LT(step.ref, bvh.nodes.size());
    const unsigned full = cull::full_lanes(masks.mask(step.ref, 0), masks.resolution) & step.box_hits();
    EXPECT_EQ(full & ~step.survivors(), 0u);
    EXPECT_EQ(full & step.uncertain(), 0u);
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      if ((step.box_hits() >> lane & 1) == 0) continue;
      EXPECT_TRUE((full >> lane & 1) == 0 || *key == 0);
      ++key;
    }
  }
  EXPECT_EQ(key, list.keys.data() + list.keys.size());
}

TEST_P(DesignsAgree, on_every_step_key_and_hit_and_leave_full_masks_unasked) {
  const std::uint64_t seed = oracle::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  const auto& [name, options] = GetParam();
  const scene::Scene scene = scene::load(name);
  const accel::Bvh4 bvh = accel::build(scene.mesh, {});
  cull::ObjectMasks masks = cull::build_object_masks(bvh, options, 2);
  std::shared_ptr<const cull::CompressionLut> lut;
  if (options.entries != 0) {
    cull::CompressedMasks compressed = cull::compress(bvh, masks, options, 2);
    masks = std::move(compressed.masks);
    lut = std::make_shared<const cull::CompressionLut>(std::move(compressed.lut));
  }
  const std::vector<intersect::Ray> rays = random_rays(scene, 1500, seed);
  std::optional<Walked> expected;
  for (const Design design : {Design::MaskLut, Design::Projection, Design::Dedup, Design::BitTable}) {
    if (design == Design::BitTable && lut == nullptr) continue;
    SCOPED_TRACE(std::string(to_string(design)));
    const Walked walked = walk(bvh, masks, cull::MaskTester(design, options, lut), rays);
    if (!expected) {
      expected = walked;
      expect_full_masks_unasked(bvh, masks, walked.list);
      EXPECT_GT(walked.list.keys.size(), rays.size());
    }
    EXPECT_EQ(walked.list.steps, expected->list.steps);
    EXPECT_EQ(walked.list.keys, expected->list.keys);
    for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(intersect::same_bits(walked.hits[i], expected->hits[i]));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, DesignsAgree,
    testing::Values(Case{"gen:hair-ball?strands=300", {}},
                    Case{"gen:hair-ball?strands=300", {.ray_resolution = 8, .entries = 256}},
                    Case{"gen:tilted-quads?quads=1000", {.ray_resolution = 7, .entries = 64}},
                    Case{"gen:tilted-quads?quads=1000", {.resolution = 6, .ray_resolution = 6, .entries = 16}},
                    Case{"gen:foliage?twigs=60", {.resolution = 3, .ray_resolution = 8}},
                    Case{"gen:foliage?twigs=60", {.resolution = 2, .ray_resolution = 5, .entries = 16}}),
    [](const auto& info) {
      const cull::MaskOptions& o = info.param.options;
      std::string name = "case";
      for (const int number : {static_cast<int>(info.index), o.resolution, o.ray_resolution, o.entries})
        name.append("_").append(std::to_string(number));
      return name;
    });

}  // namespace
}  // namespace ctu
