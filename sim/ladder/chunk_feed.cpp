#include "sim/ladder/chunk_feed.h"

#include <algorithm>

namespace ctu::ladder {
namespace {

constexpr std::size_t kBlocksKept = 3;
constexpr std::uint64_t kNoRay = ~std::uint64_t{0};
constexpr double kSettled = 0.5;  ///< of a warm-up: caches are shown when so much of it is left

std::uint64_t visits_of(const reference::RayBlock& block, std::uint64_t ray) {
  const std::uint64_t i = ray - block.first_ray;
  return block.steps.first_step[i + 1] - block.steps.first_step[i];
}

}  // namespace

ChunkFeed::ChunkFeed(const TraceWork& work, const ChunkPlan& plan, const WarmUp& warm_up)
    : work_(work), plan_(plan), warm_up_(warm_up), done_(work.range.first) {
  begin_chunk();
}

std::uint64_t ChunkFeed::total_rays() const {
  std::uint64_t rays = 0;
  for (const Chunk& chunk : plan_.chunks) rays += chunk.last - chunk.first;
  return rays;
}

void ChunkFeed::run(pipeline::Engine& engine) {
  engine_ = &engine;
  if (shown_ < at_) show_caches();  // the engine has asked for the first rays when it was made
  engine.advance(pipeline::kNever);
  drain_ = since(start_);
}

std::shared_ptr<const reference::RayBlock> ChunkFeed::next() {
  while (chunk_ < plan_.chunks.size()) {
    const Chunk& chunk = plan_.chunks[chunk_];
    if (at_ == shown_ && engine_ != nullptr) show_caches();
    if (at_ < chunk.first) return part(std::min(chunk.first, shown_));
    if (at_ < chunk.last) {
      if (!measuring_) start_ = now();
      measuring_ = true;
      return part(chunk.last);
    }
    windows_.push_back(since(start_));
    windows_.back().rays = static_cast<double>(chunk.last - chunk.first);
    start_ = now();
    measuring_ = false;
    done_ = chunk.last;
    if (++chunk_ == plan_.chunks.size()) break;
    begin_chunk();
  }
  return nullptr;
}

void ChunkFeed::begin_chunk() {
  const std::uint64_t chunk = plan_.chunks[chunk_].first;
  at_ = warm_up_begin(chunk, 1);
  shown_ = at_ == done_ ? kNoRay : warm_up_begin(chunk, kSettled);
}

/// The first of the rays that are this share of the warm-up in front of a ray; not one of a chunk before.
std::uint64_t ChunkFeed::warm_up_begin(std::uint64_t end, double share) {
  std::uint64_t first = end, visited = 0;
  const auto enough = [&] {
    const auto rays = static_cast<double>(end - first), work = rays + static_cast<double>(visited);
    return rays >= share * static_cast<double>(warm_up_.simulated_rays) &&
           (work >= share * static_cast<double>(warm_up_.simulated_work) ||
            rays >= share * static_cast<double>(warm_up_.most_simulated_rays));
  };
  while (first > done_ && !enough()) {
    --first;
    visited += visits_of(block(work_.reader.block_of(first)), first);
  }
  return first;
}

/// What rays in front of `shown_` visit, as far back as it matters, but not those of a chunk before.
void ChunkFeed::show_caches() {
  const std::uint64_t end = std::exchange(shown_, kNoRay);
  std::uint64_t first = end, visits = 0;
  while (first > done_ && visits < warm_up_.shown_visits && end - first < warm_up_.most_shown_rays) {
    --first;
    visits += visits_of(block(work_.reader.block_of(first)), first);
  }
  while (first < end) {
    const reference::RayBlock& from = block(work_.reader.block_of(first));
    const std::uint64_t last = std::min(end, from.first_ray + from.rays.size());
    show_rays(from, first - from.first_ray, last - from.first_ray);
    first = last;
  }
}

/// A visit of each ray under way in turn, as many rays as there are contexts: what is used between two uses of a line
/// is then about as much as in the unit.
void ChunkFeed::show_rays(const reference::RayBlock& block, std::uint64_t next, std::uint64_t last) {
  const reference::StepList& list = block.steps;
  struct UnderWay {
    std::uint64_t step = 0, end = 0;
  };
  std::vector<UnderWay> rays(warm_up_.contexts);
  bool more = true;
  while (more) {
    more = false;
    for (UnderWay& ray : rays) {
      while (ray.step == ray.end && next < last) {
        ray = {list.first_step[next], list.first_step[next + 1]};
        ++next;
      }
      if (ray.step == ray.end) continue;
      engine_->warm(list.steps[ray.step++].ref);
      more = true;
    }
  }
}

ChunkFeed::Moment ChunkFeed::now() const {
  if (engine_ == nullptr) return {};  // it is being made
  return {static_cast<double>(engine_->now()), engine_->log().events().size()};
}

Window ChunkFeed::since(const Moment& start) const {
  const Moment end = now();
  Window window;
  window.cycles = end.cycle - start.cycle;
  for (std::size_t i = start.events; i < end.events; ++i) {
    const pipeline::Event& event = engine_->log().events()[i];
    if (!event.is_return) ++(event.step.is_leaf() ? window.leaf_visits : window.node_visits);
  }
  return window;
}

const reference::RayBlock& ChunkFeed::block(std::uint64_t number) {
  for (const auto& [known, block] : blocks_)
    if (known == number) return *block;
  if (blocks_.size() == kBlocksKept) blocks_.erase(blocks_.begin());
  const traces::RayRange whole{work_.reader.first_ray(number), work_.reader.first_ray(number + 1)};
  blocks_.emplace_back(number, traces::TraceFeed(work_.reader, whole, work_.bvh, work_.masks, work_.tester).next());
  return *blocks_.back().second;
}

/// Rays up to `last`, as far as their block reaches.
std::shared_ptr<const reference::RayBlock> ChunkFeed::part(std::uint64_t last) {
  const reference::RayBlock& from = block(work_.reader.block_of(at_));
  const std::uint64_t first = std::exchange(at_, std::min(last, from.first_ray + from.rays.size()));
  return std::make_shared<const reference::RayBlock>(
      traces::part_of(from, first - from.first_ray, at_ - from.first_ray));
}

}  // namespace ctu::ladder
