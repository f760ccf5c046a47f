#include "traces/trace_feed.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/reference/block_walk.h"
#include "traces/validate_block.h"

namespace ctu::traces {
namespace {

RayRange clamp_range(const TraceReader& reader, RayRange range) {
  range.last = std::min(range.last, reader.rays());
  if (range.first > range.last)
    throw Error(reader.path(), fmt::format("there is no ray {}; the trace has {}", range.first, reader.rays()),
                "choose a range within the trace");
  return range;
}

template <class T>
std::vector<T> slice_of(const std::vector<T>& all, std::uint64_t first, std::uint64_t last) {
  return {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(last)};
}

std::vector<std::uint64_t> rebased(const std::vector<std::uint64_t>& starts, std::uint64_t first, std::uint64_t last) {
  std::vector<std::uint64_t> out = slice_of(starts, first, last + 1);
  const std::uint64_t base = out.front();
  for (std::uint64_t& start : out) start -= base;
  return out;
}

reference::PacketList part_of(const reference::PacketList& all, std::uint64_t first, std::uint64_t last) {
  reference::PacketList part;
  for (const std::uint32_t border : all.first_ray)
    if (border > first && border < last) part.first_ray.push_back(static_cast<std::uint32_t>(border - first));
  part.first_ray.push_back(static_cast<std::uint32_t>(last - first));
  const std::uint64_t begin = all.packet_of(first), end = begin + part.packets();
  if (!all.walked() || all.first_ray[begin] != first || all.first_ray[end] != last) return part;
  part.first_visit = rebased(all.first_visit, begin, end);
  part.first_entry = rebased(all.first_entry, begin, end);
  part.visits = slice_of(all.visits, all.first_visit[begin], all.first_visit[end]);
  part.entries = slice_of(all.entries, all.first_entry[begin], all.first_entry[end]);
  return part;
}

}  // namespace

bool holds_steps(const TraceReader& reader, cull::Design design, const cull::MaskOptions& options) {
  if (!reader.has_steps(design)) return false;
  if (design == cull::Design::None) return true;
  cull::MaskOptions recorded = reader.manifest().masks;
  if (cull::event_class(design) != cull::Design::MaskLut) recorded.ray_resolution = options.ray_resolution;
  return recorded == options;
}

TraceFeed::TraceFeed(const TraceReader& reader, RayRange range)
    : reader_(reader), range_(clamp_range(reader, range)), next_ray_(range_.first) {}

TraceFeed::TraceFeed(const TraceReader& reader, RayRange range, const accel::Bvh4& bvh, const cull::ObjectMasks* masks,
                     const cull::MaskTester& tester)
    : TraceFeed(reader, range) {
  bvh_ = &bvh;
  if (holds_steps(reader, tester.design(), tester.options())) steps_of_ = tester.design();
  // Packets may be cut by the range, and then visit other nodes than were recorded.
  if (!steps_of_ || packets().any()) walk_with(bvh, masks, tester);
}

void TraceFeed::walk_with(const accel::Bvh4& bvh, const cull::ObjectMasks* masks, const cull::MaskTester& tester) {
  if (!reader_.has_primitive_boxes()) {
    traversal_.emplace(bvh, masks, tester);
    return;
  }
  leaf_boxes_ = reference::leaf_boxes(bvh);
  traversal_.emplace(bvh, masks, tester, &leaf_boxes_, cull::RayBoxRule::OncePerLeaf);
}

std::shared_ptr<const reference::RayBlock> TraceFeed::next() {
  if (next_ray_ >= range_.last) return nullptr;
  const std::uint64_t number = reader_.block_of(next_ray_);
  const std::uint64_t start = reader_.first_ray(number), end = reader_.first_ray(number + 1);
  auto block = std::make_shared<reference::RayBlock>(reader_.read_block(number, steps_of_));
  if (steps_of_) validate_block(*block, *bvh_, reader_.manifest().masks, reader_.path(), packets());
  const std::uint64_t last = std::min(end, range_.last);
  if (next_ray_ != start || last != end) *block = part_of(*block, next_ray_ - start, last - start);
  const bool cuts = packets().any() && !block->packets.walked();
  if (cuts && !traversal_) refuse_any_hits(*block);
  if (traversal_ && (!steps_of_ || cuts)) walk(*block);
  next_ray_ = last;
  return block;
}

/// Of a packet that the range has made smaller it is not known which hit an any-hit ray comes to first.
void TraceFeed::refuse_any_hits(const reference::RayBlock& block) const {
  for (const intersect::Ray& ray : block.rays)
    if (ray.kind == intersect::RayKind::AnyHit)
      throw Error(reader_.path(),
                  fmt::format("rays {} to {} cut a packet of any-hit rays in two", range_.first, range_.last - 1),
                  fmt::format("begin and end at multiples of {} rays, or replay the steps", packets().size));
}

void TraceFeed::walk(reference::RayBlock& block) const {
  const std::vector<intersect::Hit> found = reference::walk_block(*traversal_, packets(), block);
  if (packets().any()) reference::expect_any_hits_found(block.rays, found, block.expected);
}

reference::RayBlock part_of(const reference::RayBlock& block, std::uint64_t first, std::uint64_t last) {
  reference::RayBlock part;
  part.first_ray = block.first_ray + first;
  part.rays = slice_of(block.rays, first, last);
  part.expected = slice_of(block.expected, first, last);
  if (!block.trees.empty()) part.trees = slice_of(block.trees, first, last);
  if (block.packets.packets() != 0) part.packets = part_of(block.packets, first, last);
  const reference::StepList& all = block.steps;
  if (all.rays() == 0) return part;
  if (!all.spared.empty()) part.steps.spared = slice_of(all.spared, first, last);
  part.steps.first_step = rebased(all.first_step, first, last);
  part.steps.first_key = rebased(all.first_key, first, last);
  part.steps.first_met = rebased(all.first_met, first, last);
  part.steps.tail_dropped = slice_of(all.tail_dropped, first, last);
  part.steps.steps = slice_of(all.steps, all.first_step[first], all.first_step[last]);
  part.steps.keys = slice_of(all.keys, all.first_key[first], all.first_key[last]);
  part.steps.met = slice_of(all.met, all.first_met[first], all.first_met[last]);
  return part;
}

}  // namespace ctu::traces
