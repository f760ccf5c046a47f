// A hard case made ready: its tree, its masks and the test over them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "model/accel/bvh4.h"
#include "model/accel/image.h"
#include "model/reference/node_test.h"
#include "model/reference/packet_walk.h"
#include "model/reference/traversal.h"
#include "sim/check/culling_setup.h"
#include "sim/check/hard_case.h"
#include "traces/mask_set.h"

namespace ctu::sim::check {

/// Which one: with the seed and the options of the command line it decides everything else.
struct SceneNumber {
  std::uint32_t generator = 0;  ///< place in generators()
  std::uint64_t scene = 0;
};

struct CheckScene {
  SceneNumber number;
  HardCase hard;
  CullingSetup setup;
  accel::Bvh4 bvh;
  traces::MaskSet masks;                        ///< empty with Design::None
  std::vector<accel::PrimitiveBox> leaf_boxes;  ///< empty without ray boxes
  std::shared_ptr<const cull::MaskTester> tester;

  /// Walks the scene as its unit does.
  reference::Traversal traversal() const;
  /// Its rays in packets; they must travel so.
  reference::PacketWalk packet_walk() const;
  reference::NodeTest node_test() const { return {bvh, &masks.masks, *tester}; }
};

using DrawSetup = std::function<CullingSetup(CaseRandom& random)>;

/// Random numbers of a scene for all that is not the case itself.
CaseRandom scene_random(std::uint64_t seed, SceneNumber number);

/// `random`: scene_random of it, from which the setup is drawn.
CheckScene make_scene(std::uint64_t seed, SceneNumber number, const DrawSetup& draw, CaseRandom& random,
                      TesterCache& testers);

/// The bytes that a unit of the scene's design fetches.
accel::Image image_of(const CheckScene& scene);

}  // namespace ctu::sim::check
