// A node of reduced precision as it lies in memory; `bits` for each coordinate, 16, 12 or 8:
//   byte   0  origin.x  4  origin.y  8  origin.z     binary32, finite
//   byte  12  exponents                              u32: x in bits 0-9, y in 10-19, z in 20-29, each 0 to 276
//   byte  16  child[4]                               u32, child_ref.h
//   byte  32  lo.x[4] lo.y[4] lo.z[4] hi.x[4] hi.y[4] hi.z[4]   `bits` each, without gaps: number i has bits
//             bits * i to bits * i + bits - 1 of what follows, bit b being bit b % 8 of byte b / 8; 0 in empty lanes
//   byte  32 + 3 * bits  masks
// What the numbers mean: box_frame.h.
#pragma once

#include <cstdint>
#include <string>

#include "model/accel/quantize.h"

namespace ctu::accel {

/// Without masks: 80, 68 or 56.
constexpr std::uint32_t compact_node_bytes(std::uint32_t bits) { return 32 + 3 * bits; }

/// Throws Error unless the node's boxes are what its frame and `bits` can say.
void write_compact_node(const Node4& node, std::uint32_t bits, std::uint8_t* p);

/// Boxes decoded.
Node4 read_compact_node(const std::uint8_t* p, std::uint32_t bits);

/// What is wrong with the bytes that decoded boxes do not show; empty: nothing.
std::string compact_node_problem(const std::uint8_t* p, std::uint32_t bits);

}  // namespace ctu::accel
