#include "model/cull/strip_masks.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/cull/mask_test.h"

namespace ctu::cull {
namespace {

std::vector<std::uint64_t> full_mask(int resolution) {
  std::vector<std::uint64_t> words(static_cast<std::size_t>(words_per_mask(resolution)));
  for (int cell = 0; cell < resolution * resolution * resolution; ++cell)
    words[static_cast<std::size_t>(cell / 64)] |= std::uint64_t{1} << (cell % 64);
  return words;
}

}  // namespace

ObjectMasks strip_masks(const accel::Bvh4& bvh, const ObjectMasks& masks, const CompressionLut* lut,
                        const std::vector<std::uint8_t>& kept) {
  if (kept.size() != bvh.nodes.size())
    throw Error("object masks",
                fmt::format("{} nodes are decided upon, the tree has {}", kept.size(), bvh.nodes.size()),
                "decide for this tree");
  ObjectMasks stripped = masks;
  const std::vector<std::uint64_t> full = full_mask(masks.resolution);
  for (std::size_t node = 0; node < bvh.nodes.size(); ++node) {
    for (std::size_t lane = 0; lane < intersect::kLanes; ++lane) {
      if ((kept[node] >> lane & 1) != 0 || bvh.nodes[node].child[lane] == accel::kEmptyChild) continue;
      const std::size_t place = node * intersect::kLanes + lane;
      std::copy(full.begin(), full.end(),
                stripped.bits.begin() + static_cast<std::ptrdiff_t>(place * static_cast<std::size_t>(masks.words)));
      if (lut != nullptr) stripped.index[place] = static_cast<std::uint16_t>(lut->entries() - 1);
    }
  }
  return stripped;
}

std::uint64_t nodes_with_masks(const accel::Bvh4& bvh, const ObjectMasks& masks) {
  std::uint64_t nodes = 0;
  for (std::uint32_t node = 0; node < bvh.nodes.size(); ++node) {
    const unsigned full = full_lanes(masks.mask(node, 0), masks.resolution);
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      if (bvh.nodes[node].child[lane] == accel::kEmptyChild || (full >> lane & 1) != 0) continue;
      ++nodes;
      break;
    }
  }
  return nodes;
}

}  // namespace ctu::cull
