#include "traces/mask_set.h"

#include <algorithm>
#include <utility>

#include "model/cull/compress.h"

namespace ctu::traces {
namespace {

std::uint32_t mask_bits(const MaskSet& set) {
  if (set.lut) return static_cast<std::uint32_t>(set.lut->index_bits());
  const auto resolution = static_cast<std::uint32_t>(set.masks.resolution);
  return resolution * resolution * resolution;
}

/// Indices become the bits of their entries; empty lanes stay zero.
void look_up(const accel::Image& image, const cull::CompressionLut& lut, cull::ObjectMasks& masks) {
  masks.index.resize(static_cast<std::size_t>(image.node_count) * intersect::kLanes);
  std::size_t place = 0;
  for (std::uint32_t node = 0; node < image.node_count; ++node) {
    const accel::Node4 lanes = accel::read_node(image, node);
    for (int lane = 0; lane < intersect::kLanes; ++lane, ++place) {
      if (lanes.child[lane] == accel::kEmptyChild) continue;
      std::uint64_t index = 0;
      accel::read_mask(image, node, lane, &index);
      masks.index[place] = static_cast<std::uint16_t>(index);
      std::copy_n(lut.entry(static_cast<int>(index)), masks.words,
                  masks.bits.data() + place * static_cast<std::size_t>(masks.words));
    }
  }
}

}  // namespace

MaskSet mask_set(const accel::Bvh4& bvh, cull::ObjectMasks masks, const cull::MaskOptions& options, int threads) {
  if (options.entries == 0) return {std::move(masks), nullptr};
  cull::CompressedMasks compressed = cull::compress(bvh, masks, options, threads);
  return {std::move(compressed.masks), std::make_shared<const cull::CompressionLut>(std::move(compressed.lut))};
}

MaskSet make_masks(const accel::Bvh4& bvh, const cull::MaskOptions& options, int threads) {
  return mask_set(bvh, cull::build_object_masks(bvh, options, threads), options, threads);
}

accel::Image image_of(const accel::Bvh4& bvh, const MaskSet* set, accel::ImageLayout layout) {
  layout.mask_bits = set == nullptr ? 0 : mask_bits(*set);
  if (set == nullptr || !set->lut)
    return accel::make_image(bvh, set == nullptr ? nullptr : set->masks.bits.data(),
                             set == nullptr ? 0 : set->masks.words, layout);
  const std::vector<std::uint64_t> indices(set->masks.index.begin(), set->masks.index.end());
  return accel::make_image(bvh, indices.data(), 1, layout);
}

cull::ObjectMasks masks_of(const accel::Image& image, const cull::MaskOptions& options,
                           const cull::CompressionLut* lut) {
  cull::ObjectMasks masks;
  masks.resolution = options.resolution;
  masks.words = cull::words_per_mask(options.resolution);
  if (image.layout.mask_bits == 0) return masks;
  masks.bits.resize(static_cast<std::size_t>(image.node_count) * intersect::kLanes *
                    static_cast<std::size_t>(masks.words));
  if (lut != nullptr) {
    look_up(image, *lut, masks);
    return masks;
  }
  std::uint64_t* to = masks.bits.data();
  for (std::uint32_t node = 0; node < image.node_count; ++node)
    for (int lane = 0; lane < intersect::kLanes; ++lane, to += masks.words) accel::read_mask(image, node, lane, to);
  return masks;
}

}  // namespace ctu::traces
