// The encoder of reduced precision: a node's frame, and each box as the tightest one that the frame can say and that
// holds the box. Decoded boxes are binary32 like any others, so all that follows, masks included, is the same as
// without; only the boxes are larger.
//
// The frame: the origin is the lower corner of the node's boxes, so that corner is exact; the step the smallest power
// of two whose 2^bits - 1 steps reach the upper corner, twice as large (and so on) where the decoded plane falls short
// by rounding. At the ends of binary32: steps are never below the smallest subnormal number, where all offsets are
// exact; where boxes are wider than the largest finite number, lower planes further than that from the origin lie too
// low, and upper ones are the largest finite number.
#pragma once

#include <cstdint>

#include "model/accel/bvh4.h"

namespace ctu::accel {

/// Planes of four boxes in steps of their node's frame; 0 for empty lanes.
struct QuantizedBoxes {
  std::uint16_t lo[3][intersect::kLanes] = {};
  std::uint16_t hi[3][intersect::kLanes] = {};
  bool operator==(const QuantizedBoxes&) const = default;
};

/// 16, 12 or 8.
constexpr bool is_reduced(std::uint32_t bits) { return bits == 16 || bits == 12 || bits == 8; }

/// For the node's finite boxes; some lane must hold one.
BoxFrame box_frame(const Node4& node, std::uint32_t bits);

/// Boxes of the node as its frame says them: for each plane the nearest one that is not inside the box. Boxes that were
/// decoded from a frame come out as they went in. The frame's origin must be at or below all lower planes, and its
/// 2^bits - 1 steps must reach all upper ones.
QuantizedBoxes quantize(const Node4& node, std::uint32_t bits);

/// The boxes as the unit sees them. Lanes without a child are empty.
intersect::Box4 decode_boxes(const QuantizedBoxes& boxes, const BoxFrame& frame, const ChildRef* child);

/// Gives every node a frame, and its boxes as they will be decoded. Before masks are made: they are those of the boxes.
/// Throws Error unless `bits` is 16, 12 or 8.
void quantize_boxes(Bvh4& bvh, std::uint32_t bits, int threads);

}  // namespace ctu::accel
