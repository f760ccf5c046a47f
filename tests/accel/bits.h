// Equality to the bit, zeros' signs included, of types that are nothing but 32-bit words.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "model/accel/bvh4.h"

namespace ctu::test {

template <class T>
bool same_bits(const T& a, const T& b) {
  using Words = std::array<std::uint32_t, sizeof(T) / sizeof(std::uint32_t)>;
  return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

inline bool same_node(const accel::Node4& a, const accel::Node4& b) {
  return same_bits(a.boxes, b.boxes) && std::equal(a.child, a.child + intersect::kLanes, b.child);
}

inline bool same_triangles(const std::vector<accel::LeafTriangle>& a, const std::vector<accel::LeafTriangle>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_bits<accel::LeafTriangle>);
}

}  // namespace ctu::test
