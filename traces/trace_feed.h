// A range of a trace's rays as a feed, block by block, with what one design visits: read where the trace has it and
// checked against the image, walked again by the reference where it has not. Both give the same steps (contract 3).
#pragma once

#include <memory>

#include "model/accel/bvh4.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/reference/ray_block.h"
#include "model/reference/traversal.h"
#include "traces/trace_reader.h"

namespace ctu::traces {

/// Rays [first, last) of a trace; `last` beyond the end means the end.
struct RayRange {
  std::uint64_t first = 0;
  std::uint64_t last = UINT64_MAX;
};

/// Whether the trace holds the steps that a tester with these options would make: R_ray matters only to designs that
/// read tables, and masks not at all without culling.
bool holds_steps(const TraceReader& reader, cull::Design design, const cull::MaskOptions& options);

class TraceFeed : public reference::RayFeed {
 public:
  /// Rays and expected hits only. The reader must outlive the feed.
  TraceFeed(const TraceReader& reader, RayRange range);

  TraceFeed(const TraceFeed&) = delete;
  TraceFeed& operator=(const TraceFeed&) = delete;

  /// With the steps of `tester`'s design. `masks` may be null for Design::None; all must outlive the feed.
  TraceFeed(const TraceReader& reader, RayRange range, const accel::Bvh4& bvh, const cull::ObjectMasks* masks,
            const cull::MaskTester& tester);

  std::shared_ptr<const reference::RayBlock> next() override;
  std::uint64_t total_rays() const override { return range_.last - range_.first; }
  reference::PacketPlan packets() const override { return reader_.manifest().packets.plan; }
  bool derives() const { return traversal_.has_value() && !steps_of_; }  ///< steps are walked again, not read

 private:
  void walk_with(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester);
  void walk(reference::RayBlock& block) const;
  void refuse_any_hits(const reference::RayBlock& block) const;

  const TraceReader& reader_;
  RayRange range_;
  std::uint64_t next_ray_;
  const accel::Bvh4* bvh_ = nullptr;
  std::optional<cull::Design> steps_of_;         ///< read from the trace
  std::vector<accel::PrimitiveBox> leaf_boxes_;  ///< what the traversal asks, with ray-box culling
  std::optional<reference::Traversal> traversal_;
};

/// Rays [first, last) of a block, counted from its start, with their hits and steps. A packet that the range cuts is a
/// smaller one, which visits other nodes; then the part's packets are not walked.
reference::RayBlock part_of(const reference::RayBlock& block, std::uint64_t first, std::uint64_t last);

}  // namespace ctu::traces
