// The bytes that the unit fetches: nodes and triangles as they lie in memory, little-endian whatever the host is.
//
// A node (the paper's Fig. 6a), lanes side by side:
//   byte   0  lo.x[4]   16  lo.y[4]   32  lo.z[4]   48  hi.x[4]   64  hi.y[4]   80  hi.z[4]    binary32
//   byte  96  child[4]                                                                        u32, child_ref.h
//   byte 112  mask[4], each ceil(mask_bits / 8) bytes, bit i in byte i / 8 at place i % 8     absent if mask_bits = 0
// Its stride is that size rounded up to a multiple of 4 and of the alignment: 112 bytes without masks, 116 with 8-bit
// indices into a compression table, 144 with 64-bit masks (R = 4), 220 with 216-bit masks (R = 6).
//
// With box_bits 16, 12 or 8 the first 112 bytes are the 80, 68 or 56 of compact_node.h; masks follow in the same way:
//   box_bits                        32    16    12     8
//   without masks                  112    80    68    56 bytes
//   with 8-bit indices             116    84    72    60
//   with 64-bit masks (R = 4)      144   112   100    88
//   with 216-bit masks (R = 6)     220   188   176   164
//
// A primitive, in leaf order: a triangle, or a sphere with bit 31 of `primitive` set
//   byte   0  v0.xyz   12  v1.xyz          24  v2.xyz   binary32
//   byte   0  centre   12  radius   16  0               binary32
//   byte  36  primitive                                 u32, its id in the scene
//   byte  40  lower.xyz   52  upper.xyz                 binary32; its box, only with primitive_boxes
// Its stride is 40 bytes, or 64 with boxes, rounded up to the alignment. Nodes start at byte 0, primitives at the next
// multiple of 64.
// Bytes that nothing above names are 0.
//
// The last `bare_nodes` nodes carry no masks, because every mask in them is full; their stride is that without masks.
// They lie behind the others without a gap, and a root is never one of them.
//
// Nodes and primitives of several trees (forest.h) lie one behind the other; a ray begins at the root of its own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"
#include "model/accel/compact_node.h"
#include "model/accel/primitive_box.h"

namespace ctu::accel {

inline constexpr std::uint32_t kNodeBytes = 112;  ///< without masks, boxes in binary32
inline constexpr std::uint32_t kTriangleBytes = 40;
inline constexpr std::uint32_t kPrimitiveBoxBytes = 24;
inline constexpr std::uint32_t kImageSectionAlignmentBytes = 64;

struct ImageLayout {
  std::uint32_t mask_bits = 0;                 ///< of one lane; 0: no masks
  std::uint32_t node_alignment_bytes = 4;      ///< a power of two, at least 4
  std::uint32_t triangle_alignment_bytes = 4;  ///< likewise
  std::uint32_t bare_nodes = 0;                ///< without masks although mask_bits is not 0; partition.h orders them
  std::uint32_t box_bits = kFullBoxBits;       ///< of a coordinate: 32, or 16, 12 or 8 of a tree that is quantized
  bool primitive_boxes = false;                ///< every primitive has its box beside it, for ray-box culling
  bool operator==(const ImageLayout&) const = default;
};

/// Throws Error unless the alignments are powers of two within bounds, mask_bits is not beyond any mask and box_bits is
/// one of four.
void validate(const ImageLayout& layout);

/// Bytes of one lane's mask.
constexpr std::uint32_t mask_bytes(const ImageLayout& layout) { return (layout.mask_bits + 7) / 8; }

/// Bytes of a primitive, its box included.
constexpr std::uint32_t primitive_bytes(const ImageLayout& layout) {
  return kTriangleBytes + (layout.primitive_boxes ? kPrimitiveBoxBytes : 0);
}

/// Bytes of a node's boxes and children; its masks follow.
constexpr std::uint32_t node_body_bytes(const ImageLayout& layout) {
  return layout.box_bits == kFullBoxBits ? kNodeBytes : compact_node_bytes(layout.box_bits);
}

struct Image {
  ImageLayout layout;
  std::uint32_t node_stride_bytes = 0, triangle_stride_bytes = 0;
  std::uint32_t bare_node_stride_bytes = 0;          ///< 0 when there are no bare nodes
  std::uint64_t node_base = 0, triangle_base = 0;    ///< byte addresses
  std::uint32_t node_count = 0, triangle_count = 0;  ///< spheres are among the triangles
  std::uint32_t sphere_count = 0;                    ///< how many they are
  int depth = 0;      ///< nodes on the longest path; a traversal stack never holds more than 3 * depth + 1 entries
  Vec3 lower, upper;  ///< bounds of the scene
  std::vector<ChildRef> further_roots;  ///< of trees number 1 and on, as Bvh4 has them
  std::vector<std::uint8_t> bytes;

  std::uint32_t trees() const { return 1 + static_cast<std::uint32_t>(further_roots.size()); }
  ChildRef root(std::uint32_t tree) const { return tree == 0 ? 0 : further_roots[tree - 1]; }
  /// Nodes that carry masks: [0, masked_nodes()).
  std::uint32_t masked_nodes() const { return node_count - layout.bare_nodes; }
  std::uint64_t node_address(std::uint32_t index) const {
    const std::uint64_t masked = std::min(index, masked_nodes());
    return node_base + masked * node_stride_bytes + (index - masked) * bare_node_stride_bytes;
  }
  std::uint64_t triangle_address(std::uint32_t index) const {
    return triangle_base + static_cast<std::uint64_t>(index) * triangle_stride_bytes;
  }
};

/// The mask of node n, lane l is `masks[(n * 4 + l) * words_per_mask]` and the words behind it, lowest bits first;
/// bits from mask_bits on are dropped. `masks` may be null when layout.mask_bits is 0. Throws Error on a layout that
/// is not one (alignment, words that do not hold mask_bits), and on boxes that its box_bits cannot say.
Image make_image(const Bvh4& bvh, const std::uint64_t* masks, int words_per_mask, const ImageLayout& layout);

/// Reading one thing at its address, boxes decoded. Throws Error when the index is out of range.
Node4 read_node(const Image& image, std::uint32_t node);
LeafTriangle read_triangle(const Image& image, std::uint32_t triangle);
/// Throws Error for an image without primitive_boxes.
PrimitiveBox read_primitive_box(const Image& image, std::uint32_t triangle);
/// Fills ceil(mask_bits / 64) words. Throws Error for a node that carries no masks.
void read_mask(const Image& image, std::uint32_t node, int lane, std::uint64_t* words);

/// The tree an image was made of, bit for bit. The image must be valid.
Bvh4 decode(const Image& image);

/// Throws Error unless every traversal of the image ends within its bytes: sizes and strides as the layout says, empty
/// lanes last, every node but the roots the child of exactly one node (an earlier one, where no nodes are bare), every
/// root a node of its own with masks, every triangle in exactly one leaf, `depth` true, boxes ordered and without NaN,
/// vertices finite, spheres finite and as many as sphere_count says, primitive_boxes those that the builder gives.
void validate(const Image& image);

}  // namespace ctu::accel
