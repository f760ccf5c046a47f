#include "traces/mask_set.h"

#include <algorithm>
#include <utility>

#include "model/accel/partition.h"
#include "model/cull/compress.h"
#include "model/cull/mask_words.h"

namespace ctu::traces {
namespace {

std::uint32_t mask_bits(const MaskSet& set) {
  if (set.lut) return static_cast<std::uint32_t>(set.lut->index_bits());
  const auto resolution = static_cast<std::uint32_t>(set.masks.resolution);
  return resolution * resolution * resolution;
}

/// Whether any lane that has a child has a mask that is not full.
bool carries_masks(const accel::Node4& node, const cull::ObjectMasks& masks, std::uint32_t index,
                   const std::vector<std::uint64_t>& full) {
  for (int lane = 0; lane < intersect::kLanes; ++lane)
    if (node.child[lane] != accel::kEmptyChild && !std::equal(full.begin(), full.end(), masks.mask(index, lane)))
      return true;
  return false;
}

template <class T>
std::vector<T> ordered(const std::vector<T>& values, const std::vector<std::uint32_t>& old_index) {
  if (values.empty()) return {};
  const std::size_t each = values.size() / old_index.size();
  std::vector<T> out;
  out.reserve(values.size());
  for (const std::uint32_t old : old_index) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(old * each);
    out.insert(out.end(), first, first + static_cast<std::ptrdiff_t>(each));
  }
  return out;
}

/// The mask of one lane as the image has it: bits, or what an index stands for.
class LaneMasks {
 public:
  LaneMasks(const accel::Image& image, const cull::CompressionLut* lut, cull::ObjectMasks& masks)
      : image_(image), lut_(lut), masks_(masks), full_(cull::full_mask(masks.resolution)) {}

  void read(std::uint32_t node, int lane) {
    const std::size_t place = static_cast<std::size_t>(node) * intersect::kLanes + static_cast<unsigned>(lane);
    std::uint64_t* const to = masks_.bits.data() + place * static_cast<std::size_t>(masks_.words);
    const bool bare = node >= image_.masked_nodes();
    if (lut_ == nullptr) {
      if (bare)
        std::copy(full_.begin(), full_.end(), to);
      else
        accel::read_mask(image_, node, lane, to);
      return;
    }
    auto index = static_cast<std::uint64_t>(lut_->entries() - 1);
    if (!bare) accel::read_mask(image_, node, lane, &index);
    masks_.index[place] = static_cast<std::uint16_t>(index);
    std::copy_n(lut_->entry(static_cast<int>(index)), masks_.words, to);
  }

 private:
  const accel::Image& image_;
  const cull::CompressionLut* lut_;
  cull::ObjectMasks& masks_;
  const std::vector<std::uint64_t> full_;
};

}  // namespace

MaskSet mask_set(const accel::Bvh4& bvh, cull::ObjectMasks masks, const cull::MaskOptions& options, int threads) {
  if (options.entries == 0) return {std::move(masks), nullptr};
  cull::CompressedMasks compressed = cull::compress(bvh, masks, options, threads);
  return {std::move(compressed.masks), std::make_shared<const cull::CompressionLut>(std::move(compressed.lut))};
}

MaskSet make_masks(const accel::Bvh4& bvh, const cull::MaskOptions& options, int threads) {
  return mask_set(bvh, cull::build_object_masks(bvh, options, threads), options, threads);
}

std::uint32_t put_full_last(accel::Bvh4& bvh, MaskSet& set) {
  const std::vector<std::uint64_t> full = cull::full_mask(set.masks.resolution);
  std::vector<bool> carries(bvh.nodes.size());
  for (std::uint32_t n = 0; n < bvh.nodes.size(); ++n) carries[n] = carries_masks(bvh.nodes[n], set.masks, n, full);
  const accel::Partition partition = accel::partition_nodes(bvh, carries);
  set.masks.bits = ordered(set.masks.bits, partition.old_index);
  set.masks.index = ordered(set.masks.index, partition.old_index);
  return partition.bare_nodes;
}

accel::Image image_of(const accel::Bvh4& bvh, const MaskSet* set, accel::ImageLayout layout) {
  layout.mask_bits = set == nullptr ? 0 : mask_bits(*set);
  if (set == nullptr) layout.bare_nodes = 0;
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
  if (lut != nullptr) masks.index.resize(static_cast<std::size_t>(image.node_count) * intersect::kLanes);
  LaneMasks lanes(image, lut, masks);
  for (std::uint32_t node = 0; node < image.node_count; ++node) {
    const accel::Node4 children = accel::read_node(image, node);
    for (int lane = 0; lane < intersect::kLanes; ++lane)
      if (children.child[lane] != accel::kEmptyChild) lanes.read(node, lane);  // empty lanes stay zero
  }
  return masks;
}

}  // namespace ctu::traces
