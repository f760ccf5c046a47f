// The 32-bit reference from a node to a child: another node, a leaf (a run of triangles), or nothing.
//   bit 31 = 0: inner node, bits 30..0 its index
//   bit 31 = 1: leaf, bits 30..27 = triangles - 1, bits 26..0 = index of the first triangle
//   0xFFFFFFFF: empty lane
#pragma once

#include <cstdint>

namespace ctu::accel {

using ChildRef = std::uint32_t;

inline constexpr ChildRef kEmptyChild = 0xFFFFFFFFu;
inline constexpr int kMaxLeafTriangles = 15;                    // 16 with the last index is kEmptyChild
inline constexpr std::uint32_t kMaxTriangles = (1u << 27) - 1;  // what 27 bits can name

constexpr bool is_leaf(ChildRef ref) { return (ref >> 31) != 0 && ref != kEmptyChild; }
constexpr bool is_inner(ChildRef ref) { return (ref >> 31) == 0; }
constexpr ChildRef make_leaf(std::uint32_t first, int count) {
  return 0x80000000u | (static_cast<std::uint32_t>(count - 1) << 27) | first;
}
constexpr std::uint32_t leaf_first(ChildRef ref) { return ref & 0x07FFFFFFu; }
constexpr int leaf_count(ChildRef ref) { return static_cast<int>((ref >> 27) & 15u) + 1; }

}  // namespace ctu::accel
