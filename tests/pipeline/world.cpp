#include "tests/pipeline/world.h"

#include <limits>
#include <stdexcept>

#include "model/accel/build.h"
#include "model/cull/compress.h"
#include "model/cull/object_masks.h"
#include "model/pipeline/backpressure.h"
#include "model/reference/block_walk.h"
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

accel::Bvh4 quantized(accel::Bvh4 tree, std::uint32_t box_bits) {
  if (box_bits != accel::kFullBoxBits) accel::quantize_boxes(tree, box_bits, 1);
  return tree;
}

cull::ObjectMasks masks_of(const accel::Bvh4& tree, cull::Design design, const cull::MaskOptions& options) {
  return design == cull::Design::None ? cull::ObjectMasks{} : cull::build_object_masks(tree, options, 1);
}

/// Replaces the masks where they are to be compressed.
std::shared_ptr<const cull::CompressionLut> compress_masks(const accel::Bvh4& tree, const cull::MaskOptions& options,
                                                           cull::ObjectMasks& masks) {
  if (options.entries == 0 || masks.bits.empty()) return nullptr;
  cull::CompressedMasks compressed = cull::compress(tree, masks, options, 1);
  masks = std::move(compressed.masks);
  return std::make_shared<const cull::CompressionLut>(std::move(compressed.lut));
}

}  // namespace

void add_spheres(scene::Mesh& mesh) {
  constexpr int kSpheres = 120;
  const accel::Bvh4 tree = accel::build(mesh, {});
  const float size = tree.upper.x - tree.lower.x;
  Random random;
  for (int i = 0; i < kSpheres; ++i) {
    scene::Sphere sphere;
    for (int axis = 0; axis < 3; ++axis)
      sphere.centre[axis] = tree.lower[axis] + random.next() * (tree.upper[axis] - tree.lower[axis]);
    const float share = random.next();
    sphere.radius = i == 0 ? 0 : 0.1f * size * share * share;
    mesh.spheres.push_back(sphere);
  }
}

std::uint64_t VectorFeed::total_rays() const {
  std::uint64_t rays = 0;
  for (const auto& block : blocks_) rays += block->rays.size();
  return rays;
}

World::World(const std::string& scene, cull::Design design, int rays, const cull::MaskOptions& options,
             std::uint32_t box_bits, bool primitive_boxes)
    : World(accel::build(scene::load(scene).mesh, {}), design, rays, options, box_bits, primitive_boxes) {}

World::World(accel::Bvh4 tree, cull::Design design, int rays, const cull::MaskOptions& options, std::uint32_t box_bits,
             bool primitive_boxes)
    : World(std::move(tree), design, std::vector<intersect::Ray>(), options, box_bits, primitive_boxes) {
  record(lines_through(tree_, rays));
}

World::World(accel::Bvh4 tree, cull::Design design, const std::vector<intersect::Ray>& rays,
             const cull::MaskOptions& options, std::uint32_t box_bits, bool primitive_boxes)
    : tree_(quantized(std::move(tree), box_bits)),
      masks_(masks_of(tree_, design, options)),
      lut_(compress_masks(tree_, options, masks_)),
      tester_(design, options, lut_),
      image_(make_image(box_bits, primitive_boxes)) {
  record(rays);
}

accel::Image World::make_image(std::uint32_t box_bits, bool primitive_boxes) const {
  accel::ImageLayout layout{.box_bits = box_bits, .primitive_boxes = primitive_boxes};
  if (masks_.bits.empty()) return accel::make_image(tree_, nullptr, 0, layout);
  const auto r = static_cast<std::uint32_t>(masks_.resolution);
  layout.mask_bits = lut_ == nullptr ? r * r * r : static_cast<std::uint32_t>(lut_->index_bits());
  if (lut_ == nullptr) return accel::make_image(tree_, masks_.bits.data(), masks_.words, layout);
  const std::vector<std::uint64_t> indices(masks_.index.begin(), masks_.index.end());
  return accel::make_image(tree_, indices.data(), 1, layout);
}

reference::Traversal World::traversal(const std::vector<accel::PrimitiveBox>& boxes) const {
  return {tree_, &masks_, tester_, image_.layout.primitive_boxes ? &boxes : nullptr, cull::RayBoxRule::OncePerLeaf};
}

void World::record(const std::vector<intersect::Ray>& rays) {
  const std::vector<accel::PrimitiveBox> boxes = reference::leaf_boxes(tree_);
  const reference::Traversal culled = traversal(boxes);
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
    bare->packets.visits.clear();
    bare->packets.entries.clear();
    bare->packets.first_visit = bare->packets.first_entry = {0};
    block = std::move(bare);
  }
}

void World::travel_in(const reference::PacketPlan& packets) {
  packets_ = packets;
  const std::vector<accel::PrimitiveBox> boxes = reference::leaf_boxes(tree_);
  const reference::Traversal culled = traversal(boxes);
  for (auto& block : blocks_) {
    auto travelling = std::make_shared<reference::RayBlock>(*block);
    const auto rays = static_cast<std::uint32_t>(block->rays.size());
    travelling->packets = reference::cut_packets(rays, packets.size, block->trees);
    const std::vector<intersect::Hit> found = reference::walk_block(culled, packets, *travelling);
    reference::expect_any_hits_found(travelling->rays, found, travelling->expected);
    block = std::move(travelling);
  }
}

void World::walk_trees(const std::vector<std::uint8_t>& trees) {
  const std::vector<accel::PrimitiveBox> boxes = reference::leaf_boxes(tree_);
  const reference::Traversal culled = traversal(boxes);
  for (auto& block : blocks_) {
    auto walking = std::make_shared<reference::RayBlock>(*block);
    for (std::size_t i = 0; i < block->rays.size(); ++i)
      walking->trees.push_back({trees[(block->first_ray + i) % trees.size()], 1, 2});
    const std::vector<intersect::Hit> found = reference::walk_block(culled, {}, *walking);
    reference::expect_any_hits_found(walking->rays, found, walking->expected);
    block = std::move(walking);
  }
}

pipeline::UnitConfig World::config() const {
  pipeline::UnitConfig config;
  config.mask_test.design = tester_.design();
  return config;
}

std::unique_ptr<pipeline::Engine> World::engine(const pipeline::UnitConfig& config,
                                                const pipeline::EngineOptions& options) {
  feeds_.push_back(std::make_unique<VectorFeed>(blocks_, packets_));
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

namespace {

/// A root of `lanes` leaves, each over the box [0, 4]^3 and with these triangles.
accel::Bvh4 equal_leaves(int lanes, const std::vector<accel::LeafTriangle>& triangles) {
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
    root.child[lane] =
        accel::make_leaf(static_cast<std::uint32_t>(tree.triangles.size()), static_cast<int>(triangles.size()));
    for (accel::LeafTriangle triangle : triangles) {
      triangle.primitive = static_cast<std::uint32_t>(tree.triangles.size());
      tree.triangles.push_back(triangle);
    }
  }
  tree.nodes.push_back(root);
  return tree;
}

}  // namespace

accel::Bvh4 stacked_leaves(int lanes, int triangles) {
  std::vector<accel::LeafTriangle> leaf;
  for (int i = 0; i < triangles; ++i) {
    const float z = 0.5f + static_cast<float>(i) * 0.125f;
    leaf.push_back({{0, 0, z}, {4, 0, z}, {0, 4, z}, 0});
  }
  return equal_leaves(lanes, leaf);
}

accel::Bvh4 filled_leaves(int lanes) {
  std::vector<accel::LeafTriangle> leaf;
  for (const float z : {0.5f, 1.5f, 2.5f, 3.5f}) {
    leaf.push_back({{0, 0, z}, {4, 0, z}, {0, 4, z}, 0});
    leaf.push_back({{4, 4, z}, {4, 0, z}, {0, 4, z}, 0});
  }
  return equal_leaves(lanes, leaf);
}

intersect::Ray ray_through_leaves() {
  intersect::Ray ray;
  ray.origin = {1.5f, 1.5f, -1};
  ray.direction = {0, 0, 1};
  ray.tmax = 100;
  return ray;
}

std::vector<intersect::Ray> rays_from_outside(const World& world) {
  std::vector<intersect::Ray> outside;
  for (const auto& block : world.blocks())
    for (const intersect::Ray& ray : block->rays) {
      bool away = false;
      for (int axis = 0; axis < 3; ++axis)
        away |= ray.origin[axis] < world.tree().lower[axis] || ray.origin[axis] > world.tree().upper[axis];
      if (away) outside.push_back(ray);
    }
  return outside;
}

std::uint64_t counter(const pipeline::UnitResult& result, const std::string& name) {
  for (const auto& counter : result.counters)
    if (counter.name == name) return counter.value;
  throw std::out_of_range("no counter " + name);
}

}  // namespace ctu::test
