// One walk over the tree fills the masks of every box. The boxes above the walk's place stand on a stack; at a leaf,
// each triangle is voxelized into those of them that take triangles (all of them, or, with limited L, those fewer
// than L levels above the leaf), and with limited L each finished box fills the one L levels above it.
// A box drops out for a whole subtree as soon as the subtree can only set bits that are set: its bounds touch one cell,
// or only cells already occupied. So the walk's cost is near the number of triangles, not times the depth.
//
// A refit walks the same way, but only boxes below which a triangle has moved are emptied and filled again. Under a
// kept box there are only kept ones, and the walk goes on there for the sake of the boxes above alone. A kept subtree
// can set no bit that a box above it did not have, unless that box itself is another one now: what is left to find in
// it are those bits of the old mask that nothing else has set yet, and the walk ends as soon as there are none.
//
// Threads: the tree is cut into subtrees; a task writes the masks of its own boxes, and keeps what its triangles set in
// the boxes above the cut aside until all tasks are done. Masks only ever gain bits, and dropping a
// box never changes what bits it ends with, so the result does not depend on the order.
#include "model/cull/mask_walk.h"

#include "model/base/parallel.h"
#include "model/cull/fill_pattern.h"
#include "model/cull/sphere_cells.h"

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

/// What is walked for: all of a tree, or what a refit has changed.
struct Job {
  const accel::Bvh4& bvh;
  int levels;
  const accel::RefitChanges* changes;  ///< null: everything is new
  ObjectMasks& masks;

  bool limited() const { return levels != kUnlimitedLevels; }
  /// Whether the child's mask stays: nothing below it has changed.
  bool keeps(Slot slot) const { return changes != nullptr && !changes->moved(slot.node, slot.lane); }
  /// The bits that kept subtrees can set in the child's mask, which has its old bits still.
  template <int R>
  MaskWords<R> bits_of_kept(Slot slot) const {
    MaskWords<R> bits;
    if (changes == nullptr || changes->box(slot.node, slot.lane))
      bits.fill(~std::uint64_t{0});
    else
      std::copy_n(mask_of(masks, slot), kWords<R>, bits.begin());
    return bits;
  }
};

/// A box on the way down, and the bits to set for it.
template <int R>
struct OpenBox {
  Bounds bounds;
  BoxGrid<R> grid;
  std::uint64_t* mask;
  MaskWords<R> from_kept;  ///< bits that kept subtrees can set
};

/// Walks one subtree.
template <int R>
class Walk {
 public:
  explicit Walk(const Job& job) : job_(job), bvh_(job.bvh) {}

  /// A box above the subtree that is made anew; its bits go to `mask`.
  void open_above(Slot slot, std::uint64_t* mask) {
    takers_.push_back(static_cast<int>(open_.size()));
    open(slot, mask);
  }

  /// `depth`: boxes above the subtree. With limited L, those more than L levels up take nothing from it.
  void run(Slot slot, int depth) {
    const int first = job_.limited() ? std::max(depth - job_.levels, 0) : 0;
    visit(slot, depth, static_cast<std::size_t>(first), takers_.size());
  }

 private:
  void open(Slot slot, std::uint64_t* mask) {
    const Bounds bounds = bounds_of(bvh_, slot);
    open_.push_back({bounds, BoxGrid<R>(bounds), mask, job_.bits_of_kept<R>(slot)});
  }

  /// `takers_[first, last)` are the open boxes that still take triangles from here.
  void visit(Slot slot, int depth, std::size_t first, std::size_t last) {
    const ChildRef ref = child_of(bvh_, slot);
    if (ref == accel::kEmptyChild) return;
    const bool kept = job_.keeps(slot);
    if (kept && first == last) return;
    const Bounds bounds = bounds_of(bvh_, slot);
    const int fills = keep_takers(bounds, kept, depth, first, last);
    if (!kept) {
      std::uint64_t* const mask = mask_of(job_.masks, slot);
      takers_.push_back(static_cast<int>(open_.size()));
      open(slot, mask);
      std::fill_n(mask, kWords<R>, 0);
    }
    visit_below(ref, depth, last);
    if (fills >= 0) fill(fills, bounds, mask_of(job_.masks, slot));
    takers_.resize(last);
    if (!kept) open_.pop_back();
  }

  /// For the boxes that `takers_` has from `first` on.
  void visit_below(ChildRef ref, int depth, std::size_t first) {
    const std::size_t last = takers_.size();
    if (first == last) return;
    if (accel::is_leaf(ref)) return add_leaf(ref, first);
    for (int lane = 0; lane < intersect::kLanes; ++lane) visit({ref, lane}, depth + 1, first, last);
  }

  /// Appends those of `takers_[first, last)` that a subtree in `bounds` can still change by its triangles. Returns the
  /// one that its mask can still change, or -1.
  int keep_takers(const Bounds& bounds, bool kept, int depth, std::size_t first, std::size_t last) {
    int fills = -1;
    for (std::size_t i = first; i < last; ++i) {
      const int taker = takers_[i];
      const OpenBox<R>& box = open_[static_cast<std::size_t>(taker)];
      const CellRange range = closed_cells<R>(box.grid, bounds);
      MaskWords<R> cells = box_of_cells<R>(range);
      if (kept)
        for (int w = 0; w < kWords<R>; ++w) cells[w] &= box.from_kept[w];
      if (holds<R>(box.mask, cells)) continue;
      if (is_one_cell(range, box.grid.flat_axes))
        add_cells<R>(box.mask, cells);
      else if (job_.limited() && depth - taker == job_.levels)
        fills = taker;
      else
        takers_.push_back(taker);
    }
    return fills;
  }

  void add_leaf(ChildRef ref, std::size_t first_taker) {
    const accel::LeafTriangle* triangles = bvh_.triangles.data() + accel::leaf_first(ref);
    for (std::size_t i = first_taker; i < takers_.size(); ++i) {
      const OpenBox<R>& box = open_[static_cast<std::size_t>(takers_[i])];
      for (int t = 0; t < accel::leaf_count(ref); ++t) {
        if (triangles[t].is_sphere())
          add_sphere<R>(box.bounds, triangles[t].sphere(), box.mask);
        else
          add_triangle<R>(box.grid, triangles[t].v0, triangles[t].v1, triangles[t].v2, box.mask);
      }
    }
  }

  void fill(int taker, const Bounds& child, const std::uint64_t* child_mask) {
    const OpenBox<R>& to = open_[static_cast<std::size_t>(taker)];
    fill_from<R>(to.grid, to.bounds, to.mask, child, child_mask);
  }

  const Job& job_;
  const accel::Bvh4& bvh_;
  std::vector<OpenBox<R>> open_;  ///< those made anew, from the root's child down: a box's index is its depth
  std::vector<int> takers_;       ///< runs of indices into open_, one run a level
};

/// The top of each tree: boxes that are cut further, and below them the subtrees that are tasks.
struct Cut {
  struct Box {
    Slot slot;
    int above;  ///< index of the box it lies in, or -1
  };
  std::vector<Box> top, tasks;  ///< a box of `top` comes after the one it lies in
};

/// Of every node, the triangles below it in leaves to be walked for their own sake.
std::vector<std::uint32_t> count_triangles(const Job& job) {
  // Children come after their parent, so one pass from the back counts.
  std::vector<std::uint32_t> triangles(job.bvh.nodes.size());
  for (auto n = static_cast<std::uint32_t>(triangles.size()); n-- > 0;) {
    if (job.changes != nullptr && !job.changes->any(n)) continue;
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const ChildRef ref = job.bvh.nodes[n].child[lane];
      if (accel::is_leaf(ref) && !job.keeps({n, lane}))
        triangles[n] += static_cast<std::uint32_t>(accel::leaf_count(ref));
      if (accel::is_inner(ref)) triangles[n] += triangles[ref];
    }
  }
  return triangles;
}

Cut cut_tree(const Job& job) {
  const std::vector<std::uint32_t> triangles = count_triangles(job);
  const std::uint32_t most = std::max<std::uint32_t>(triangles.empty() ? 0 : triangles[0] / 128, 1024);

  Cut cut;
  auto place = [&](std::uint32_t node, int above) {
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const ChildRef ref = job.bvh.nodes[node].child[lane];
      if (ref == accel::kEmptyChild || (above < 0 && job.keeps({node, lane}))) continue;
      const bool large = accel::is_inner(ref) && triangles[ref] > most;
      (large ? cut.top : cut.tasks).push_back({{node, lane}, above});
    }
  };
  for (std::uint32_t tree = 0; tree < job.bvh.trees() && !job.bvh.nodes.empty(); ++tree) place(job.bvh.root(tree), -1);
  for (std::size_t i = 0; i < cut.top.size(); ++i) place(child_of(job.bvh, cut.top[i].slot), static_cast<int>(i));
  return cut;
}

template <int R>
class Builder {
 public:
  explicit Builder(const Job& job) : job_(job), cut_(cut_tree(job)), aside_(cut_.tasks.size()) {}

  void run(int threads) {
    parallel_chunks(cut_.tasks.size(), 1, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t task = first; task < last; ++task) run_task(task);
    });
    for (const Cut::Box& box : cut_.top) std::fill_n(mask_of(job_.masks, box.slot), kWords<R>, 0);
    for (std::size_t task = 0; task < aside_.size(); ++task) merge(task);
    if (job_.limited())
      for (std::size_t i = cut_.top.size(); i-- > 0;) fill_top(static_cast<int>(i));
  }

 private:
  /// Indices into cut_.top of the boxes a task lies in, from the root down. All of them are made anew: a box with
  /// triangles enough to be cut has moved ones.
  std::vector<int> path_of(const Cut::Box& box) const {
    std::vector<int> path;
    for (int i = box.above; i >= 0; i = cut_.top[static_cast<std::size_t>(i)].above) path.push_back(i);
    std::reverse(path.begin(), path.end());
    return path;
  }

  void run_task(std::size_t task) {
    const std::vector<int> path = path_of(cut_.tasks[task]);
    aside_[task].resize(path.size());
    Walk<R> walk(job_);
    for (std::size_t i = 0; i < path.size(); ++i)
      walk.open_above(cut_.top[static_cast<std::size_t>(path[i])].slot, aside_[task][i].data());
    walk.run(cut_.tasks[task].slot, static_cast<int>(path.size()));
  }

  void merge(std::size_t task) {
    const std::vector<int> path = path_of(cut_.tasks[task]);
    for (std::size_t i = 0; i < path.size(); ++i) add_cells<R>(top_mask(path[i]), aside_[task][i]);
  }

  /// Deeper boxes first, so that a box is finished when it fills the one L levels above it.
  void fill_top(int from) {
    int to = from;
    for (int level = 0; level < job_.levels && to >= 0; ++level) to = cut_.top[static_cast<std::size_t>(to)].above;
    if (to < 0) return;
    const Bounds box = bounds_of(job_.bvh, cut_.top[static_cast<std::size_t>(to)].slot);
    fill_from<R>(BoxGrid<R>(box), box, top_mask(to), bounds_of(job_.bvh, cut_.top[static_cast<std::size_t>(from)].slot),
                 top_mask(from));
  }

  std::uint64_t* top_mask(int top) { return mask_of(job_.masks, cut_.top[static_cast<std::size_t>(top)].slot); }

  const Job& job_;
  const Cut cut_;
  std::vector<std::vector<MaskWords<R>>> aside_;  ///< [task][box above it]; zero to begin with
};

}  // namespace

void walk_masks(const accel::Bvh4& bvh, int levels, const accel::RefitChanges* changes, ObjectMasks& masks,
                int threads) {
  const Job job{bvh, levels, changes, masks};
  with_resolution(masks.resolution, [&](auto r) { Builder<r()>(job).run(threads); });
}

}  // namespace ctu::cull
