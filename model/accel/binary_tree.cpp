#include "model/accel/binary_tree.h"

#include <bit>
#include <cstddef>

#include "model/accel/split.h"
#include "model/base/parallel.h"

namespace ctu::accel {
namespace {

/// A subtree to be built. `levels` bounds the edges below its root and never falls below ceil_log2(count).
struct Subtree {
  std::uint32_t node, first, count;
  int levels;
};

int ceil_log2(std::uint32_t n) { return std::bit_width(n - 1); }

class Builder {
 public:
  Builder(std::span<TriangleRef> refs, int bins) : refs_(refs), bins_(bins), nodes_(2 * refs.size() - 1) {}

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
      nodes_[subtree.node] = {half_area(refs_[subtree.first].box), 1, 0};
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
    const auto n = static_cast<std::uint32_t>(even ? split_median(refs) : split_sah(refs, bins_));
    nodes_[s.node] = {half_area(box), s.count, n};
    left = {left_child(s.node), s.first, n, s.levels - 1};
    right = {right_child(s.node, n), s.first + n, s.count - n, s.levels - 1};
  }

  std::span<TriangleRef> refs_;
  int bins_;
  std::vector<BinaryNode> nodes_;
};

}  // namespace

std::vector<BinaryNode> build_binary_tree(std::span<TriangleRef> refs, int bins, int threads) {
  return Builder(refs, bins).run(threads);
}

}  // namespace ctu::accel
