// Which tree, masks and mask test a hard case is asked with: what the command line fixes, and the rest drawn, so that
// one campaign covers all designs and resolutions.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "model/accel/compact_node.h"
#include "model/cull/mask_test.h"
#include "model/cull/options.h"
#include "model/reference/entry_list.h"
#include "model/reference/packet_list.h"
#include "sim/check/case_random.h"

namespace ctu::sim::check {

struct CullingSetup {
  cull::Design design = cull::Design::Projection;
  cull::MaskOptions masks;
  int leaf_triangles = 4;                        ///< at most
  std::uint32_t box_bits = accel::kFullBoxBits;  ///< of a coordinate of a node's boxes
  bool primitive_boxes = false;                  ///< ray boxes cull primitives in the leaves
  reference::PacketPlan packets{};               ///< rays travel so, if at all
};

/// "mask-lut R 4, R_ray 6, L inf, leaves of 2".
std::string to_string(const CullingSetup& setup);

struct SetupChoice {
  std::vector<cull::Design> designs;  ///< one of these; must not be empty
  std::optional<int> resolution{}, ray_resolution{}, levels{};
  std::optional<std::uint32_t> box_bits{};  ///< of a coordinate of boxes
  std::optional<bool> primitive_boxes{}, packets{};
  int most_packet_entries = reference::kMostEntries;
};

/// All that decide a ray's answer in software.
std::vector<cull::Design> all_designs();

/// Throws Error where no scene can have what is chosen.
void validate(const SetupChoice& choice);

/// Draws what is not chosen: R 2..8, R_ray R..2R as far as a table of it is made in a moment, L mostly unlimited,
/// leaves of 1 to 15 triangles, and for some scenes compressed masks, boxes of reduced precision, ray boxes or rays in
/// packets. R_ray is raised to R where R is above it.
CullingSetup draw_setup(const SetupChoice& choice, CaseRandom& random);

/// Mask tests by what their tables depend on, shared by scenes and threads. Compressed masks have their own.
class TesterCache {
 public:
  std::shared_ptr<const cull::MaskTester> get(cull::Design design, int resolution, int ray_resolution);

 private:
  using Key = std::tuple<cull::Design, int, int>;
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const cull::MaskTester>> testers_;
};

}  // namespace ctu::sim::check
