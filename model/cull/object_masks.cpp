// One walk over the tree fills the masks of every box. The boxes above the walk's place stand on a stack; at a leaf,
// each triangle is voxelized into those of them that take triangles (all of them, or, with limited L, those fewer
// than L levels above the leaf), and with limited L each finished box fills the one L levels above it.
// A box drops out for a whole subtree as soon as the subtree can only set bits that are set: its bounds touch one cell,
// or only cells already occupied. So the walk's cost is near the number of triangles, not times the depth.
//
// Threads: the tree is cut into subtrees; a task writes the masks of its own boxes, and keeps what its triangles set in
// the boxes above the cut aside until all tasks are done. Masks only ever gain bits, and dropping a
// box never changes what bits it ends with, so the result does not depend on the order.
#include "model/cull/object_masks.h"

#include "model/base/parallel.h"
#include "model/cull/fill_pattern.h"

namespace ctu::cull {
namespace {

using accel::ChildRef;

/// A child's place in the tree.
struct Slot {
  std::uint32_t node;
  int lane;
};

Bounds bounds_of(const accel::Bvh4& bvh, Slot slot) {
  const intersect::Box4& boxes = bvh.nodes[slot.node].boxes;
  Bounds bounds;
  for (int a = 0; a < 3; ++a) {
    bounds.lower[a] = boxes.lo[a][slot.lane];
    bounds.upper[a] = boxes.hi[a][slot.lane];
  }
  return bounds;
}

ChildRef child_of(const accel::Bvh4& bvh, Slot slot) { return bvh.nodes[slot.node].child[slot.lane]; }

std::uint64_t* mask_of(ObjectMasks& masks, Slot slot) {
  const std::size_t child =
      static_cast<std::size_t>(slot.node) * intersect::kLanes + static_cast<std::size_t>(slot.lane);
  return masks.bits.data() + child * static_cast<std::size_t>(masks.words);
}

/// A box on the way down, and the bits to set for it.
template <int R>
struct OpenBox {
  Bounds bounds;
  BoxGrid<R> grid;
  std::uint64_t* mask;
};

/// Walks one subtree.
template <int R>
class Walk {
 public:
  Walk(const accel::Bvh4& bvh, int levels, ObjectMasks& masks) : bvh_(bvh), levels_(levels), masks_(masks) {}

  /// A box above the subtree; its bits go to `mask`.
  void open_above(Slot slot, std::uint64_t* mask) {
    takers_.push_back(static_cast<int>(open_.size()));
    open(slot, mask);
  }

  void run(Slot slot) { visit(slot, 0, takers_.size()); }

 private:
  void open(Slot slot, std::uint64_t* mask) {
    const Bounds bounds = bounds_of(bvh_, slot);
    open_.push_back({bounds, BoxGrid<R>(bounds), mask});
  }

  /// `takers_[first, last)` are the open boxes that still take triangles from here.
  void visit(Slot slot, std::size_t first, std::size_t last) {
    const ChildRef ref = child_of(bvh_, slot);
    if (ref == accel::kEmptyChild) return;
    const int depth = static_cast<int>(open_.size());
    open(slot, mask_of(masks_, slot));
    keep_takers(first, last, depth);
    takers_.push_back(depth);
    if (accel::is_leaf(ref)) {
      add_leaf(ref, last);
    } else {
      const std::size_t end = takers_.size();
      for (int lane = 0; lane < intersect::kLanes; ++lane) visit({ref, lane}, last, end);
    }
    takers_.resize(last);
    if (levels_ != kUnlimitedLevels && depth >= levels_) fill_above(depth);
    open_.pop_back();
  }

  /// Appends those of `takers_[first, last)` that the subtree under the newest open box can still change.
  void keep_takers(std::size_t first, std::size_t last, int depth) {
    const Bounds bounds = open_.back().bounds;
    for (std::size_t i = first; i < last; ++i) {
      const int taker = takers_[i];
      if (levels_ != kUnlimitedLevels && depth - taker >= levels_) continue;
      const OpenBox<R>& box = open_[static_cast<std::size_t>(taker)];
      const CellRange range = closed_cells<R>(box.grid, bounds);
      const MaskWords<R> cells = box_of_cells<R>(range);
      if (holds<R>(box.mask, cells)) continue;
      if (is_one_cell(range, box.grid.flat_axes)) {
        add_cells<R>(box.mask, cells);
        continue;
      }
      takers_.push_back(taker);
    }
  }

  void add_leaf(ChildRef ref, std::size_t first_taker) {
    const accel::LeafTriangle* triangles = bvh_.triangles.data() + accel::leaf_first(ref);
    for (std::size_t i = first_taker; i < takers_.size(); ++i) {
      const OpenBox<R>& box = open_[static_cast<std::size_t>(takers_[i])];
      for (int t = 0; t < accel::leaf_count(ref); ++t)
        add_triangle<R>(box.grid, triangles[t].v0, triangles[t].v1, triangles[t].v2, box.mask);
    }
  }

  void fill_above(int depth) {
    const OpenBox<R>& from = open_[static_cast<std::size_t>(depth)];
    const OpenBox<R>& to = open_[static_cast<std::size_t>(depth - levels_)];
    fill_from<R>(to.grid, to.bounds, to.mask, from.bounds, from.mask);
  }

  const accel::Bvh4& bvh_;
  const int levels_;
  ObjectMasks& masks_;
  std::vector<OpenBox<R>> open_;  ///< from the root's child down
  std::vector<int> takers_;       ///< runs of indices into open_, one run a level
};

/// The tree's top: boxes that are cut further, and below them the subtrees that are tasks.
struct Cut {
  struct Box {
    Slot slot;
    int above;  ///< index of the box it lies in, or -1
  };
  std::vector<Box> top, tasks;  ///< a box of `top` comes after the one it lies in
};

Cut cut_tree(const accel::Bvh4& bvh) {
  // Children come after their parent, so one pass from the back counts.
  std::vector<std::uint32_t> triangles(bvh.nodes.size());
  for (std::size_t n = bvh.nodes.size(); n-- > 0;)
    for (const ChildRef ref : bvh.nodes[n].child) {
      if (accel::is_leaf(ref)) triangles[n] += static_cast<std::uint32_t>(accel::leaf_count(ref));
      if (accel::is_inner(ref)) triangles[n] += triangles[ref];
    }
  const std::uint32_t most = std::max<std::uint32_t>(triangles.empty() ? 0 : triangles[0] / 128, 1024);

  Cut cut;
  auto place = [&](std::uint32_t node, int above) {
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const ChildRef ref = bvh.nodes[node].child[lane];
      if (ref == accel::kEmptyChild) continue;
      const bool large = accel::is_inner(ref) && triangles[ref] > most;
      (large ? cut.top : cut.tasks).push_back({{node, lane}, above});
    }
  };
  if (!bvh.nodes.empty()) place(0, -1);
  for (std::size_t i = 0; i < cut.top.size(); ++i) place(child_of(bvh, cut.top[i].slot), static_cast<int>(i));
  return cut;
}

template <int R>
class Builder {
 public:
  Builder(const accel::Bvh4& bvh, int levels, ObjectMasks& masks)
      : bvh_(bvh), levels_(levels), masks_(masks), cut_(cut_tree(bvh)), aside_(cut_.tasks.size()) {}

  void run(int threads) {
    parallel_chunks(cut_.tasks.size(), 1, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t task = first; task < last; ++task) run_task(task);
    });
    for (std::size_t task = 0; task < aside_.size(); ++task) merge(task);
    if (levels_ != kUnlimitedLevels)
      for (std::size_t i = cut_.top.size(); i-- > 0;) fill_top(static_cast<int>(i));
  }

 private:
  /// Indices into cut_.top of the boxes a task lies in, from the root down.
  std::vector<int> path_of(const Cut::Box& box) const {
    std::vector<int> path;
    for (int i = box.above; i >= 0; i = cut_.top[static_cast<std::size_t>(i)].above) path.push_back(i);
    std::reverse(path.begin(), path.end());
    return path;
  }

  void run_task(std::size_t task) {
    const std::vector<int> path = path_of(cut_.tasks[task]);
    aside_[task].resize(path.size());
    Walk<R> walk(bvh_, levels_, masks_);
    for (std::size_t i = 0; i < path.size(); ++i)
      walk.open_above(cut_.top[static_cast<std::size_t>(path[i])].slot, aside_[task][i].data());
    walk.run(cut_.tasks[task].slot);
  }

  void merge(std::size_t task) {
    const std::vector<int> path = path_of(cut_.tasks[task]);
    for (std::size_t i = 0; i < path.size(); ++i) add_cells<R>(top_mask(path[i]), aside_[task][i]);
  }

  /// Deeper boxes first, so that a box is finished when it fills the one L levels above it.
  void fill_top(int from) {
    int to = from;
    for (int level = 0; level < levels_ && to >= 0; ++level) to = cut_.top[static_cast<std::size_t>(to)].above;
    if (to < 0) return;
    const Bounds box = bounds_of(bvh_, cut_.top[static_cast<std::size_t>(to)].slot);
    fill_from<R>(BoxGrid<R>(box), box, top_mask(to), bounds_of(bvh_, cut_.top[static_cast<std::size_t>(from)].slot),
                 top_mask(from));
  }

  std::uint64_t* top_mask(int top) { return mask_of(masks_, cut_.top[static_cast<std::size_t>(top)].slot); }

  const accel::Bvh4& bvh_;
  const int levels_;
  ObjectMasks& masks_;
  const Cut cut_;
  std::vector<std::vector<MaskWords<R>>> aside_;  ///< [task][box above it]; zero to begin with
};

}  // namespace

ObjectMasks build_object_masks(const accel::Bvh4& bvh, const MaskOptions& options, int threads) {
  validate_object_masks(options);
  ObjectMasks masks;
  masks.resolution = options.resolution;
  masks.words = words_per_mask(options.resolution);
  masks.bits.resize(bvh.nodes.size() * intersect::kLanes * static_cast<std::size_t>(masks.words));
  with_resolution(options.resolution, [&](auto r) { Builder<r()>(bvh, options.levels, masks).run(threads); });
  return masks;
}

}  // namespace ctu::cull
