#include "tests/pipeline/world.h"

#include <limits>
#include <stdexcept>

#include "model/accel/build.h"
#include "model/cull/object_masks.h"
#include "model/pipeline/backpressure.h"
#include "model/reference/traversal.h"
#include "model/scene/load.h"
#include "tests/oracle/seed.h"

namespace ctu::test {
namespace {

constexpr std::size_t kRaysPerBlock = 150;

/// Random numbers in [0, 1) by counting.
class Random {
 public:
  float next() { return static_cast<float>(pipeline::mix64(oracle::test_seed() + counter_++) >> 40) * 0x1p-24f; }

 private:
  std::uint64_t counter_ = 0;
};

std::vector<intersect::Ray> lines_through(const accel::Bvh4& tree, int count) {
  Random random;
  std::vector<intersect::Ray> rays;
  for (int i = 0; i < count; ++i) {
    Vec3 from, to;
    for (int axis = 0; axis < 3; ++axis) {
      const float lower = tree.lower[axis], size = tree.upper[axis] - lower;
      from[axis] = lower + size * (2 * random.next() - 0.5f);
      to[axis] = lower + size * random.next();
    }
    intersect::Ray ray;
    ray.origin = from;
    for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = to[axis] - from[axis];
    ray.tmax = i % 3 == 0 ? 1.0f : std::numeric_limits<float>::infinity();
    if (i % 4 == 3) ray.kind = intersect::RayKind::AnyHit;
    if (i % 50 == 49) ray.direction = {};
    rays.push_back(ray);
  }
  return rays;
}

constexpr cull::MaskOptions kMaskOptions{};

}  // namespace

std::uint64_t VectorFeed::total_rays() const {
  std::uint64_t rays = 0;
  for (const auto& block : blocks_) rays += block->rays.size();
  return rays;
}

World::World(const std::string& scene, cull::Design design, int rays)
    : tree_(accel::build(scene::load(scene).mesh, {})), tester_(design, kMaskOptions) {
  record(lines_through(tree_, rays));
}

World::World(accel::Bvh4 tree, cull::Design design, const std::vector<intersect::Ray>& rays)
    : tree_(std::move(tree)), tester_(design, kMaskOptions) {
  record(rays);
}

void World::record(const std::vector<intersect::Ray>& rays) {
  accel::ImageLayout layout;
  if (tester_.design() != cull::Design::None) {
    masks_ = cull::build_object_masks(tree_, kMaskOptions, 1);
    layout.mask_bits = 64;
  }
  image_ = accel::make_image(tree_, masks_.bits.empty() ? nullptr : masks_.bits.data(), masks_.words, layout);

  const reference::Traversal culled(tree_, &masks_, tester_);
  for (std::size_t first = 0; first < rays.size(); first += kRaysPerBlock) {
    auto block = std::make_shared<reference::RayBlock>();
    block->first_ray = first;
    for (std::size_t i = first; i < rays.size() && i < first + kRaysPerBlock; ++i) {
      block->rays.push_back(rays[i]);
      // What the unit must return: with culling, the hit that culling leaves.
      block->expected.push_back(culled.trace(rays[i], &block->steps));
    }
    blocks_.push_back(std::move(block));
  }
  rays_ = rays.size();
}

void World::forget_steps() {
  for (auto& block : blocks_) {
    auto bare = std::make_shared<reference::RayBlock>(*block);
    bare->steps.clear();
    block = std::move(bare);
  }
}

pipeline::UnitConfig World::config() const {
  pipeline::UnitConfig config;
  config.mask_test.design = tester_.design();
  return config;
}

std::unique_ptr<pipeline::Engine> World::engine(const pipeline::UnitConfig& config,
                                                const pipeline::EngineOptions& options) {
  feeds_.push_back(std::make_unique<VectorFeed>(blocks_));
  return pipeline::make_engine(config, {image_, tester_, *feeds_.back()}, options);
}

pipeline::UnitResult World::run(const pipeline::UnitConfig& config, const pipeline::EngineOptions& options) {
  return pipeline::run_to_end(*engine(config, options));
}

reference::Counts World::counts() const {
  reference::Counts counts;
  for (const auto& block : blocks_) counts += reference::count_steps(block->steps, 0, block->steps.rays());
  return counts;
}

accel::Bvh4 stacked_leaves(int lanes, int triangles) {
  accel::Bvh4 tree;
  tree.lower = {0, 0, 0};
  tree.upper = {4, 4, 4};
  tree.depth = 1;
  accel::Node4 root{};
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    const bool there = lane < lanes;
    for (int axis = 0; axis < 3; ++axis) {
      root.boxes.lo[axis][lane] = there ? 0.0f : std::numeric_limits<float>::infinity();
      root.boxes.hi[axis][lane] = there ? 4.0f : -std::numeric_limits<float>::infinity();
    }
    root.child[lane] = accel::kEmptyChild;
    if (!there) continue;
    root.child[lane] = accel::make_leaf(static_cast<std::uint32_t>(tree.triangles.size()), triangles);
    for (int i = 0; i < triangles; ++i) {
      const auto id = static_cast<std::uint32_t>(tree.triangles.size());
      const float z = 0.5f + static_cast<float>(i) * 0.125f;
      tree.triangles.push_back({{0, 0, z}, {4, 0, z}, {0, 4, z}, id});
    }
  }
  tree.nodes.push_back(root);
  return tree;
}

intersect::Ray ray_through_leaves() {
  intersect::Ray ray;
  ray.origin = {1, 1, -1};
  ray.direction = {0, 0, 1};
  ray.tmax = 100;
  return ray;
}

std::uint64_t counter(const pipeline::UnitResult& result, const std::string& name) {
  for (const auto& counter : result.counters)
    if (counter.name == name) return counter.value;
  throw std::out_of_range("no counter " + name);
}

}  // namespace ctu::test
