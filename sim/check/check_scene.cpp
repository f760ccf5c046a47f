#include "sim/check/check_scene.h"

#include "model/accel/build.h"
#include "model/accel/quantize.h"
#include "model/reference/packet_forming.h"

namespace ctu::sim::check {

CaseRandom scene_random(std::uint64_t seed, SceneNumber number) {
  constexpr std::uint32_t kBehindGenerators = 0x10000;
  return CaseRandom(seed, kBehindGenerators + number.generator, number.scene);
}

namespace {

/// Rays of a packet go about the same way from about the same place, as far as there are such.
void gather_alike(std::vector<intersect::Ray>& rays, int size) {
  const reference::FormingOptions forming{size, static_cast<int>(rays.size()), reference::Forming::Origin};
  std::vector<intersect::Ray> gathered;
  gathered.reserve(rays.size());
  for (const std::uint32_t place : reference::packet_order(rays, forming)) gathered.push_back(rays[place]);
  rays = std::move(gathered);
}

}  // namespace

CheckScene make_scene(std::uint64_t seed, SceneNumber number, const DrawSetup& draw, CaseRandom& random,
                      TesterCache& testers) {
  CheckScene scene;
  scene.number = number;
  scene.hard = make_case(seed, number.generator, number.scene);
  scene.setup = draw(random);
  if (scene.setup.packets.any()) gather_alike(scene.hard.rays, scene.setup.packets.size);
  accel::BuildOptions build;
  build.max_leaf_triangles = scene.setup.leaf_triangles;
  scene.bvh = accel::build(scene.hard.mesh, build);
  if (scene.setup.box_bits != accel::kFullBoxBits) accel::quantize_boxes(scene.bvh, scene.setup.box_bits, 1);
  if (scene.setup.primitive_boxes) scene.leaf_boxes = reference::leaf_boxes(scene.bvh);
  const cull::MaskOptions& masks = scene.setup.masks;
  if (scene.setup.design != cull::Design::None) scene.masks = traces::make_masks(scene.bvh, masks, 1);
  if (scene.masks.lut)
    scene.tester = std::make_shared<const cull::MaskTester>(scene.setup.design, masks, scene.masks.lut);
  else
    scene.tester = testers.get(scene.setup.design, masks.resolution, masks.ray_resolution);
  return scene;
}

reference::Traversal CheckScene::traversal() const {
  return {bvh, &masks.masks, *tester, setup.primitive_boxes ? &leaf_boxes : nullptr, cull::RayBoxRule::OncePerLeaf};
}

reference::PacketWalk CheckScene::packet_walk() const {
  return {bvh, setup.packets, hard.rays,
          reference::cut_packets(static_cast<std::uint32_t>(hard.rays.size()), setup.packets.size)};
}

accel::Image image_of(const CheckScene& scene) {
  accel::ImageLayout layout;
  layout.box_bits = scene.setup.box_bits;
  layout.primitive_boxes = scene.setup.primitive_boxes;
  return traces::image_of(scene.bvh, scene.setup.design == cull::Design::None ? nullptr : &scene.masks, layout);
}

}  // namespace ctu::sim::check
