// The image as the stages use it: addresses for the fetches, children for the stack, and what the arithmetic reads,
// decoded once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/accel/image.h"
#include "model/cull/mask_test.h"

namespace ctu::pipeline {

/// Addresses, in bytes, of something fetched: [first, last].
struct ByteSpan {
  std::uint64_t first = 0, last = 0;
};

class UnitImage {
 public:
  /// The masks in the image are those that `tester` asks: R^3 bits, or where it has a compression LUT an index into it.
  /// `arithmetic` false keeps only what replaying recorded outcomes needs. `packet_entries`: with how many entries on
  /// its stack a ray may begin; 0: rays travel alone.
  UnitImage(const accel::Image& image, const cull::MaskTester& tester, bool arithmetic, int packet_entries = 0);

  ByteSpan node_bytes(std::uint32_t node) const {
    if (node < masked_nodes_) {
      const std::uint64_t first = node_base_ + node * node_stride_;
      return {first, first + node_stride_ - 1};
    }
    const std::uint64_t first = bare_base_ + (node - masked_nodes_) * bare_stride_;
    return {first, first + bare_stride_ - 1};
  }
  ByteSpan leaf_bytes(accel::ChildRef leaf) const {
    const std::uint64_t first = triangle_base_ + accel::leaf_first(leaf) * triangle_stride_;
    return {first, first + static_cast<std::uint64_t>(accel::leaf_count(leaf)) * triangle_stride_ - 1};
  }
  /// Bytes of an accel::ChildRef that names a node or a leaf.
  ByteSpan bytes(accel::ChildRef ref) const { return accel::is_leaf(ref) ? leaf_bytes(ref) : node_bytes(ref); }

  /// What a node's visit reads here will be asked for.
  void prefetch(accel::ChildRef ref) const {
    if (accel::is_leaf(ref)) return;
    __builtin_prefetch(children_[ref].data());
    __builtin_prefetch(&full_lanes_[ref]);
  }
  accel::ChildRef child(std::uint32_t node, int lane) const { return children_[node][static_cast<unsigned>(lane)]; }
  std::uint32_t primitive(std::uint32_t triangle) const {
    return primitives_[triangle] & ~accel::LeafTriangle::kSphereBit;
  }
  bool is_sphere(std::uint32_t triangle) const {
    return spheres_ != 0 && (primitives_[triangle] & accel::LeafTriangle::kSphereBit) != 0;
  }
  std::uint32_t spheres() const { return spheres_; }
  /// Whether every primitive has its box beside it.
  bool primitive_boxes() const { return has_primitive_boxes_; }
  std::uint32_t trees() const { return static_cast<std::uint32_t>(roots_.size()); }
  /// Where the rays of a tree begin.
  accel::ChildRef root(std::uint32_t tree) const { return roots_[tree]; }
  std::uint32_t node_count() const { return static_cast<std::uint32_t>(children_.size()); }
  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(primitives_.size()); }
  const std::array<accel::ChildRef, 4>& children(std::uint32_t node) const { return children_[node]; }
  /// Entries a ray's stack can hold at most when the nearest child never goes there: 3 for each level, and those that
  /// it begins with.
  int stack_bound() const { return 3 * depth_ + packet_entries_; }
  int packet_entries() const { return packet_entries_; }
  /// Bits of a coordinate of the boxes as they lie in memory; below 32 they are decoded before the box test.
  bool decodes_boxes() const { return box_bits_ != accel::kFullBoxBits; }
  std::uint32_t box_bits() const { return box_bits_; }
  /// First byte behind the image: where spilled stack entries go.
  std::uint64_t end() const { return end_; }

  /// Lanes (bits) whose object mask is full.
  unsigned full_lanes(std::uint32_t node) const { return full_lanes_[node]; }
  /// Whether object masks are compressed, and then a lane's entry of the compression LUT.
  bool compressed() const { return !mask_index_.empty(); }
  std::uint32_t mask_index(std::uint32_t node, int lane) const {
    return mask_index_[static_cast<std::size_t>(node) * 4 + static_cast<unsigned>(lane)];
  }

  // Arithmetic only:
  const intersect::Box4& boxes(std::uint32_t node) const { return boxes_[node]; }
  const accel::LeafTriangle& triangle(std::uint32_t index) const { return triangles_[index]; }
  const accel::PrimitiveBox& primitive_box(std::uint32_t index) const { return primitive_boxes_[index]; }
  /// Object mask of a lane: R^3 bits.
  const std::uint64_t* mask(std::uint32_t node, int lane) const {
    if (compressed()) return lut_->entry(static_cast<int>(mask_index(node, lane)));
    return masks_.data() + (static_cast<std::size_t>(node) * 4 + static_cast<unsigned>(lane)) * mask_words_;
  }

 private:
  void read_masks(const accel::Image& image, const cull::MaskTester& tester, bool arithmetic);
  void read_indices(const accel::Image& image);

  std::uint32_t masked_nodes_ = 0, box_bits_ = accel::kFullBoxBits;
  std::uint64_t bare_base_ = 0, bare_stride_ = 0;
  std::uint64_t node_base_ = 0, node_stride_ = 0, triangle_base_ = 0, triangle_stride_ = 0, end_ = 0;
  int depth_ = 0, packet_entries_ = 0;
  const cull::CompressionLut* lut_;
  std::size_t mask_words_;
  std::vector<accel::ChildRef> roots_;
  std::vector<std::array<accel::ChildRef, 4>> children_;
  std::uint32_t spheres_;
  bool has_primitive_boxes_;
  std::vector<std::uint32_t> primitives_;
  std::vector<std::uint8_t> full_lanes_;
  std::vector<std::uint16_t> mask_index_;
  std::vector<intersect::Box4> boxes_;
  std::vector<accel::LeafTriangle> triangles_;
  std::vector<accel::PrimitiveBox> primitive_boxes_;
  std::vector<std::uint64_t> masks_;
};

}  // namespace ctu::pipeline
