// Which of several trees (accel/forest.h) a ray walks, and what that saves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ctu::reference {

/// 4-wide box tests and primitive tests count one each, without any culling.
struct RayTree {
  std::uint8_t tree = 0;
  std::uint32_t own_tests = 0;     ///< of the ray in its tree
  std::uint32_t global_tests = 0;  ///< ... in tree 0, over the whole scene
  bool operator==(const RayTree&) const = default;
};

/// Tree of ray i; where there is only one, `trees` is empty.
inline std::uint32_t tree_of(std::span<const RayTree> trees, std::uint64_t i) {
  return trees.empty() ? 0 : trees[i].tree;
}

}  // namespace ctu::reference
