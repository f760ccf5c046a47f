#include "model/cull/compress.h"

#include <algorithm>
#include <utility>

#include "model/base/parallel.h"
#include "model/cull/mask_selection.h"
#include "model/cull/requirement_luts.h"

namespace ctu::cull {
namespace {

constexpr std::size_t kNodesPerChunk = 4096;

}  // namespace

ChildWeights selection_weights(const accel::Bvh4& bvh, Selection selection) {
  return selection == Selection::Refined ? sah_weights(bvh) : area_weights(bvh);
}

ObjectMasks replace_masks(const accel::Bvh4& bvh, const ObjectMasks& masks, const CompressionLut& lut, int threads) {
  ObjectMasks replaced;
  replaced.resolution = masks.resolution;
  replaced.words = masks.words;
  replaced.bits.resize(masks.bits.size());
  replaced.index.resize(bvh.nodes.size() * intersect::kLanes);
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
  return replaced;
}

CompressedMasks compress(const accel::Bvh4& bvh, const ObjectMasks& masks, const MaskOptions& options, int threads) {
  CompressionLut lut =
      select_masks(masks, selection_weights(bvh, options.selection), options.selection, options.entries);
  ObjectMasks replaced = replace_masks(bvh, masks, lut, threads);
  return {std::move(lut), std::move(replaced)};
}

}  // namespace ctu::cull
