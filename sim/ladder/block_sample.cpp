#include "sim/ladder/block_sample.h"

#include <algorithm>

namespace ctu::ladder {

BlockSample::BlockSample(const TraceWork& work, std::uint64_t most_rays) : work_(work) {
  const std::uint64_t first = work.range.first, last = std::min(work.range.last, work.reader.rays());
  const std::uint64_t first_block = work.reader.block_of(first),
                      blocks = work.reader.block_of(last - 1) + 1 - first_block;
  const std::uint64_t rays_per_block = (last - first + blocks - 1) / blocks;
  const std::uint64_t wanted = std::clamp<std::uint64_t>(most_rays / rays_per_block, 1, blocks);
  if (last - first <= most_rays || wanted == blocks) {
    ranges_.push_back({first, last});
  } else {
    for (std::uint64_t i = 0; i < wanted; ++i) {
      const std::uint64_t block = first_block + (2 * i + 1) * blocks / (2 * wanted);
      ranges_.push_back(
          {std::max(first, work.reader.first_ray(block)), std::min(last, work.reader.first_ray(block + 1))});
    }
  }
  for (const traces::RayRange& range : ranges_) rays_ += range.last - range.first;
}

std::shared_ptr<const reference::RayBlock> BlockSample::next() {
  while (true) {
    if (feed_ != nullptr)
      if (auto block = feed_->next()) return block;
    if (next_range_ == ranges_.size()) return nullptr;
    feed_ =
        std::make_unique<traces::TraceFeed>(work_.reader, ranges_[next_range_++], work_.bvh, work_.masks, work_.tester);
  }
}

}  // namespace ctu::ladder
