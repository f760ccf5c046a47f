// Object masks: which cells of a child's box hold geometry (paper 3.1.1 and 3.2.1), conservative: every cell
// whose closed volume a triangle touches is set.
#pragma once

#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/cull/options.h"

namespace ctu::cull {

/// The masks of a node's lanes: lane 0's words, the other lanes' behind them; and, when masks are compressed, the
/// lanes' entries in the compression LUT.
struct NodeMasks {
  const std::uint64_t* bits = nullptr;
  const std::uint16_t* index = nullptr;
};

/// The mask of `node`, `lane` is words [ (node*4+lane)*words, +words ); empty lanes are zero.
struct ObjectMasks {
  int resolution = 4;
  int words = 1;
  std::vector<std::uint64_t> bits;
  std::vector<std::uint16_t> index;  ///< [node*4+lane], entry of the compression LUT; empty: not compressed
  const std::uint64_t* mask(std::uint32_t node, int lane) const {
    return bits.data() + (static_cast<std::size_t>(node) * 4 + lane) * words;
  }
  NodeMasks of(std::uint32_t node) const {
    return {mask(node, 0), index.empty() ? nullptr : index.data() + static_cast<std::size_t>(node) * 4};
  }
};

/// Masks of every child. L = 1..5 takes occupancy from nodes L levels below through the filling-pattern
/// table (Algorithm 2, made conservative in binary32); unlimited voxelizes every descendant triangle.
/// The same bits for any number of threads.
ObjectMasks build_object_masks(const accel::Bvh4& bvh, const MaskOptions& options, int threads);

}  // namespace ctu::cull
