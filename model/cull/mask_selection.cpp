#include "model/cull/mask_selection.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "model/base/error.h"
#include "model/cull/distinct_masks.h"
#include "model/cull/mask_refinement.h"
#include "model/cull/mask_sample.h"
#include "model/cull/mask_words.h"

namespace ctu::cull {
namespace {

// Different masks that the refined selection works on; docs/compression.md says what more of them would give.
constexpr std::size_t kSampledMasks = 8192, kSampledMasksPerEntry = 4, kNodesPerSampledMask = 32;

std::size_t enough_masks(const ChildWeights& weights, int entries) {
  const std::size_t nodes = weights.size() / intersect::kLanes;
  return std::max(
      {kSampledMasks, kSampledMasksPerEntry * static_cast<std::size_t>(entries), nodes / kNodesPerSampledMask});
}

/// The masks that rank first by weight times set bits; equal ranks in the order of the tree. The full mask takes no
/// place: the LUT has it anyway.
std::vector<std::uint64_t> top_masks(const DistinctMasks& masks, const std::vector<double>& weights, int resolution,
                                     std::size_t count) {
  const int cells = resolution * resolution * resolution;
  std::vector<double> importance(masks.size());
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const int bits = count_bits(masks.mask(i), masks.words);
    importance[i] = weights[i] * bits;
    if (bits != cells) order.push_back(i);
  }
  count = std::min(count, order.size());
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(order.begin(), end, order.end(), [&](std::size_t a, std::size_t b) {
    return importance[a] != importance[b] ? importance[a] > importance[b] : a < b;
  });
  std::vector<std::uint64_t> top;
  for (auto i = order.begin(); i != end; ++i) top.insert(top.end(), masks.mask(*i), masks.mask(*i) + masks.words);
  return top;
}

}  // namespace

CompressionLut select_masks(const ObjectMasks& masks, const ChildWeights& weights, Selection selection, int entries) {
  if (entries < kMinEntries || entries > kMaxEntries)
    throw Error("entries of the compression LUT", "is " + std::to_string(entries),
                "choose a value from " + std::to_string(kMinEntries) + " to " + std::to_string(kMaxEntries));
  const auto count = static_cast<std::size_t>(entries - 1);
  if (selection == Selection::Refined) {
    const DistinctMasks sample = sample_masks(masks, weights, enough_masks(weights, entries));
    const std::vector<std::uint64_t> start = top_masks(sample, sample.sum, masks.resolution, count);
    return CompressionLut(masks.resolution, refine_masks(masks.resolution, sample, start, entries));
  }
  const DistinctMasks distinct = distinct_masks(masks, weights);
  const std::vector<double>& ranks = selection == Selection::TopPerNode ? distinct.largest : distinct.sum;
  return CompressionLut(masks.resolution, top_masks(distinct, ranks, masks.resolution, count));
}

}  // namespace ctu::cull
