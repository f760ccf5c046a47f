// The binary tree under the 4-wide one, down to single triangles. A subtree over n triangles has exactly 2n-1 nodes,
// so every node's place is known before it is made: left child at node + 1, right child at node + 2 * left triangles.
// That is why any number of threads builds the same tree.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/accel/split.h"
#include "model/accel/triangle_ref.h"
#include "model/base/parallel.h"

namespace ctu::accel {

struct BinaryNode {
  float chance;             ///< of a visit: the heuristic's, of the box of its triangles
  std::uint32_t triangles;  ///< below it: a run of the reordered refs
  std::uint32_t left;       ///< of them, in the left child; 0 in a leaf (one triangle)
};

constexpr std::uint32_t left_child(std::uint32_t node) { return node + 1; }
constexpr std::uint32_t right_child(std::uint32_t node, std::uint32_t left) { return node + 2 * left; }

/// Reorders `refs` (at least one) into leaf order. No path has more than 2 * ceil(log2(refs)) + 8 edges.
template <class Heuristic>
std::vector<BinaryNode> build_binary_tree(std::span<TriangleRef> refs, int bins, int threads,
                                          const Heuristic& heuristic);

// ---------------------------------------------------------------------------------------------------------------

namespace detail {

/// A subtree to be built. `levels` bounds the edges below its root and never falls below ceil_log2(count).
struct Subtree {
  std::uint32_t node, first, count;
  int levels;
};

inline int ceil_log2(std::uint32_t n) { return std::bit_width(n - 1); }

template <class Heuristic>
class TreeBuilder {
 public:
  TreeBuilder(std::span<TriangleRef> refs, int bins, const Heuristic& heuristic)
      : refs_(refs), bins_(bins), heuristic_(heuristic), nodes_(2 * refs.size() - 1) {}

  std::vector<BinaryNode> run(int threads) {
    const auto count = static_cast<std::uint32_t>(refs_.size());
    const Subtree root{0, 0, count, 2 * ceil_log2(count) + 8};
    if (threads <= 1) {
      build(root);
    } else {
      build_shared(root, threads);
    }
    return std::move(nodes_);
  }

 private:
  static constexpr std::uint32_t kSharedTriangles = 4096;  // smaller subtrees are not worth a thread's start
  static constexpr int kSharedLevels = 7;

  /// Cuts level by level with all threads, then gives them the subtrees.
  void build_shared(const Subtree& root, int threads) {
    std::vector<Subtree> open{root};
    for (int level = 0; level < kSharedLevels; ++level) {
      std::vector<Subtree> next(2 * open.size());
      parallel_chunks(open.size(), 1, threads, [&](std::size_t i, std::size_t) {
        if (open[i].count >= kSharedTriangles) {
          cut(open[i], next[2 * i], next[2 * i + 1]);
        } else {
          next[2 * i] = open[i];
        }
      });
      std::erase_if(next, [](const Subtree& s) { return s.count == 0; });
      open = std::move(next);
    }
    parallel_chunks(open.size(), 1, threads, [&](std::size_t i, std::size_t) { build(open[i]); });
  }

  void build(const Subtree& subtree) {
    if (subtree.count == 1) {
      nodes_[subtree.node] = {heuristic_.chance(refs_[subtree.first].box), 1, 0};
      return;
    }
    Subtree left, right;
    cut(subtree, left, right);
    build(left);
    build(right);
  }

  /// Makes the subtree's root and says what is below it.
  void cut(const Subtree& s, Subtree& left, Subtree& right) {
    const auto refs = refs_.subspan(s.first, s.count);
    Box3 box = Box3::empty();
    for (const TriangleRef& ref : refs) box.grow(ref.box);
    const bool even = s.levels <= ceil_log2(s.count);
    const float chance = heuristic_.chance(box);
    const auto n = static_cast<std::uint32_t>(even ? split_median(refs) : split(refs, box, chance, bins_, heuristic_));
    nodes_[s.node] = {chance, s.count, n};
    left = {left_child(s.node), s.first, n, s.levels - 1};
    right = {right_child(s.node, n), s.first + n, s.count - n, s.levels - 1};
  }

  std::span<TriangleRef> refs_;
  int bins_;
  const Heuristic& heuristic_;
  std::vector<BinaryNode> nodes_;
};

}  // namespace detail

template <class Heuristic>
std::vector<BinaryNode> build_binary_tree(std::span<TriangleRef> refs, int bins, int threads,
                                          const Heuristic& heuristic) {
  return detail::TreeBuilder(refs, bins, heuristic).run(threads);
}

}  // namespace ctu::accel
