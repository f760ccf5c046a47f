// Consecutive rays with what they must find and, for one culling design, what they visit: the unit of recording,
// reading and replaying, small enough to stream.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "model/intersect/ray.h"
#include "model/reference/packet_list.h"
#include "model/reference/ray_tree.h"
#include "model/reference/step.h"

namespace ctu::reference {

struct RayBlock {
  std::uint64_t first_ray = 0;  ///< number of rays[0] in the whole trace
  std::vector<intersect::Ray> rays;
  std::vector<RayTree> trees;            ///< by ray; empty where there is only one tree
  std::vector<intersect::Hit> expected;  ///< of the traversal without culling
  StepList steps;                        ///< empty when only rays are wanted (exec)
  PacketList packets;                    ///< empty when the rays travel alone
};

/// Gives the blocks of a trace one after the other; null at the end.
class RayFeed {
 public:
  virtual ~RayFeed() = default;
  virtual std::shared_ptr<const RayBlock> next() = 0;
  virtual std::uint64_t total_rays() const = 0;
  /// How the rays travel: alone, unless the feed says otherwise for all its blocks.
  virtual PacketPlan packets() const { return {}; }
};

}  // namespace ctu::reference
