// Some blocks of a trace, evenly spread, as a feed: blocks are what a trace is read in.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/ladder/trace_work.h"

namespace ctu::ladder {

/// The steps of the tester's design, of all rays of the range where these are at most `most_rays`, else of whole blocks
/// with about so many, evenly spread.
class BlockSample : public reference::RayFeed {
 public:
  BlockSample(const TraceWork& work, std::uint64_t most_rays);
  std::shared_ptr<const reference::RayBlock> next() override;
  /// In the sample.
  std::uint64_t total_rays() const override { return rays_; }
  reference::PacketPlan packets() const override { return work_.reader.manifest().packets.plan; }

 private:
  TraceWork work_;
  std::vector<traces::RayRange> ranges_;
  std::size_t next_range_ = 0;
  std::unique_ptr<traces::TraceFeed> feed_;
  std::uint64_t rays_ = 0;
};

}  // namespace ctu::ladder
