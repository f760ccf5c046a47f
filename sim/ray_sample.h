// Rays of a scene held in memory: a sample of those that a trace would hold, in their order, or all of them; and what a
// unit with some masks visits for them, as a feed.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/reference/packet_walk.h"
#include "model/reference/ray_block.h"
#include "model/reference/traversal.h"
#include "traces/ray_generator.h"

namespace ctu::sim {

/// `rays[i]` finds `hits[i]` without culling.
struct RaySample {
  std::vector<intersect::Ray> rays;
  std::vector<intersect::Hit> hits;
  bool whole = false;  ///< every ray that the generator makes
};

struct SampleOptions {
  std::uint64_t rays = 0;  ///< about so many; all when there are at most twice as many; 0: all
  int runs = 0;      ///< of consecutive paths, one in each of so many equal parts; 0: of about 1024 rays, 32 at most
  double phase = 0;  ///< 0..1; another sample has another one
};

/// Runs of consecutive paths, so that a cache finds in the sample what it finds in the trace; each starts elsewhere in
/// its part. A run begins with caches that have seen other rays, so short runs find fewer lines there. 48 bytes a ray;
/// the same for any number of threads. `without_culling` is the walk that finds the hits.
RaySample sample_rays(const traces::RayGenerator& generator, const reference::Traversal& without_culling,
                      const SampleOptions& options, int threads);

/// The sample with the steps of one design, walked block by block as they are asked for: by its rays alone, or from the
/// entries of packets of consecutive rays. All must outlive the feed;
/// `masks` may be null for Design::None.
class SampleFeed : public reference::RayFeed {
 public:
  SampleFeed(const RaySample& sample, const accel::Bvh4& bvh, const cull::ObjectMasks* masks,
             const cull::MaskTester& tester, const reference::PacketPlan& packets = {});
  std::shared_ptr<const reference::RayBlock> next() override;
  std::uint64_t total_rays() const override { return sample_.rays.size(); }
  reference::PacketPlan packets() const override { return packets_; }

 private:
  const RaySample& sample_;
  reference::PacketPlan packets_;
  reference::Traversal traversal_;
  std::size_t next_ray_ = 0;
};

}  // namespace ctu::sim
