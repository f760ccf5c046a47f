#include "model/cull/compress.h"

#include <algorithm>

#include "model/base/parallel.h"
#include "model/cull/mask_selection.h"
#include "model/cull/requirement_luts.h"

namespace ctu::cull {
namespace {

constexpr std::size_t kNodesPerChunk = 4096;

void replace_masks(const accel::Bvh4& bvh, const ObjectMasks& masks, const CompressionLut& lut, int threads,
                   ObjectMasks& replaced) {
  const RequirementLuts search(lut);
  const auto words = static_cast<std::size_t>(masks.words);
  parallel_chunks(bvh.nodes.size(), kNodesPerChunk, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t child = first * intersect::kLanes; child < last * intersect::kLanes; ++child) {
      if (bvh.nodes[child / intersect::kLanes].child[child % intersect::kLanes] == accel::kEmptyChild) continue;
      const int entry = search.find(masks.bits.data() + child * words);
      replaced.index[child] = static_cast<std::uint16_t>(entry);
      std::copy_n(lut.entry(entry), words, replaced.bits.data() + child * words);
    }
  });
}

ChildWeights weights_for(const accel::Bvh4& bvh, Selection selection) {
  return selection == Selection::Refined ? sah_weights(bvh) : area_weights(bvh);
}

}  // namespace

CompressedMasks compress(const accel::Bvh4& bvh, const ObjectMasks& masks, const MaskOptions& options, int threads) {
  CompressedMasks result{select_masks(masks, weights_for(bvh, options.selection), options.selection, options.entries),
                         {}};
  result.masks.resolution = masks.resolution;
  result.masks.words = masks.words;
  result.masks.bits.resize(masks.bits.size());
  result.masks.index.resize(bvh.nodes.size() * intersect::kLanes);
  replace_masks(bvh, masks, result.lut, threads, result.masks);
  return result;
}

}  // namespace ctu::cull
