// A scene with everything a unit works on, and rays recorded for it; small enough for thousands of runs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/accel/image.h"
#include "model/cull/mask_test.h"
#include "model/pipeline/engine.h"
#include "model/reference/ray_block.h"
#include "model/reference/traversal.h"
#include "model/scene/scene.h"

namespace ctu::test {

class VectorFeed : public reference::RayFeed {
 public:
  explicit VectorFeed(const std::vector<std::shared_ptr<const reference::RayBlock>>& blocks,
                      const reference::PacketPlan& packets = {})
      : blocks_(blocks), packets_(packets) {}
  std::shared_ptr<const reference::RayBlock> next() override {
    return next_ < blocks_.size() ? blocks_[next_++] : nullptr;
  }
  std::uint64_t total_rays() const override;
  reference::PacketPlan packets() const override { return packets_; }

 private:
  const std::vector<std::shared_ptr<const reference::RayBlock>>& blocks_;
  reference::PacketPlan packets_;
  std::size_t next_ = 0;
};

class World {
 public:
  /// `rays` lines through the scene: three in four closest-hit, one in four any-hit, one in 50 invalid.
  /// `box_bits` of a coordinate of the nodes' boxes: 32, 16, 12 or 8; `primitive_boxes`: ray boxes cull in the leaves.
  World(const std::string& scene, cull::Design design, int rays, const cull::MaskOptions& options = {},
        std::uint32_t box_bits = accel::kFullBoxBits, bool primitive_boxes = false);
  /// The same of a tree that is there.
  World(accel::Bvh4 tree, cull::Design design, int rays, const cull::MaskOptions& options = {},
        std::uint32_t box_bits = accel::kFullBoxBits, bool primitive_boxes = false);
  World(accel::Bvh4 tree, cull::Design design, const std::vector<intersect::Ray>& rays,
        const cull::MaskOptions& options = {}, std::uint32_t box_bits = accel::kFullBoxBits,
        bool primitive_boxes = false);

  pipeline::UnitConfig config() const;  ///< defaults with the world's design
  std::unique_ptr<pipeline::Engine> engine(const pipeline::UnitConfig& config, const pipeline::EngineOptions& options);
  pipeline::UnitResult run(const pipeline::UnitConfig& config, const pipeline::EngineOptions& options = {});

  const accel::Bvh4& tree() const { return tree_; }
  const accel::Image& image() const { return image_; }
  const cull::MaskTester& tester() const { return tester_; }
  const std::vector<std::shared_ptr<const reference::RayBlock>>& blocks() const { return blocks_; }
  reference::Counts counts() const;
  std::uint64_t rays() const { return rays_; }
  const reference::PacketPlan& packets() const { return packets_; }
  /// The same rays without their recorded steps.
  void forget_steps();
  /// The same rays, each in its one of the trees; ray i in trees[i % size]. What they must return stays what they find
  /// in the first one, but for which hit an any-hit ray comes to.
  void walk_trees(const std::vector<std::uint8_t>& trees);
  /// The same rays in packets. What the unit must return stays what they find alone.
  void travel_in(const reference::PacketPlan& packets);

 private:
  accel::Image make_image(std::uint32_t box_bits, bool primitive_boxes) const;
  void record(const std::vector<intersect::Ray>& rays);
  /// As the unit goes about it, leaves included.
  reference::Traversal traversal(const std::vector<accel::PrimitiveBox>& boxes) const;

  accel::Bvh4 tree_;
  cull::ObjectMasks masks_;
  std::shared_ptr<const cull::CompressionLut> lut_;
  cull::MaskTester tester_;
  accel::Image image_;
  std::vector<std::shared_ptr<const reference::RayBlock>> blocks_;
  std::vector<std::unique_ptr<VectorFeed>> feeds_;
  std::uint64_t rays_ = 0;
  reference::PacketPlan packets_;
};

/// Adds balls of all sizes up to a tenth of the mesh, a point among them.
void add_spheres(scene::Mesh& mesh);

/// A root with `lanes` leaves, all at the same place, and `triangles` of one leaf: a ray along +z from below meets them
/// all.
accel::Bvh4 stacked_leaves(int lanes, int triangles);
/// The same with leaves whose object masks are full.
accel::Bvh4 filled_leaves(int lanes);
/// A ray that meets every box and triangle of both.
intersect::Ray ray_through_leaves();

/// Rays of the world whose origins lie outside the whole scene.
std::vector<intersect::Ray> rays_from_outside(const World& world);

std::uint64_t counter(const pipeline::UnitResult& result, const std::string& name);

}  // namespace ctu::test
