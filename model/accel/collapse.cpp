#include "model/accel/collapse.h"

#include <algorithm>
#include <array>

#include "model/accel/node_box.h"

namespace ctu::accel {
namespace {

/// What one subtree costs as a forest of at most 1, 2, 3 trees, each a node or a leaf of the 4-wide tree; and how:
/// `left[k]` trees of the left child make up a forest of k+1 trees (0: one tree fewer is as good). left[0]: 0 for a
/// leaf. `left[3]`: the trees of the left child among the four lanes of a node.
struct Forest {
  std::array<float, 3> cost;
  std::array<std::uint8_t, 4> left;
};

/// The cheapest way to make `trees` trees of two children.
struct Share {
  float cost;
  std::uint8_t left;
};
Share cheapest_share(const Forest& left, const Forest& right, int trees) {
  Share best{left.cost[0] + right.cost[trees - 2], 1};
  for (int j = 2; j < trees; ++j) {
    const float cost = left.cost[j - 1] + right.cost[trees - j - 1];
    if (cost < best.cost) best = {cost, static_cast<std::uint8_t>(j)};
  }
  return best;
}

Forest cheapest_forest(const BinaryNode& node, const Forest* left, const Forest* right, const BuildOptions& options) {
  const float leaf_cost = node.chance * options.triangle_cost * static_cast<float>(node.triangles);
  if (node.left == 0) return {{leaf_cost, leaf_cost, leaf_cost}, {0, 0, 0, 0}};
  const Share lanes = cheapest_share(*left, *right, 4);
  Forest forest;
  forest.left[3] = lanes.left;
  forest.cost[0] = node.chance * options.node_cost + lanes.cost;
  forest.left[0] = 1;
  if (node.triangles <= static_cast<std::uint32_t>(options.max_leaf_triangles) && leaf_cost <= forest.cost[0]) {
    forest.cost[0] = leaf_cost;
    forest.left[0] = 0;
  }
  for (int k = 1; k < 3; ++k) {
    const Share share = cheapest_share(*left, *right, k + 1);
    const bool better = share.cost < forest.cost[k - 1];
    forest.cost[k] = better ? share.cost : forest.cost[k - 1];
    forest.left[k] = better ? share.left : 0;
  }
  return forest;
}

/// Writes the 4-wide nodes depth first: a parent, then each child's subtree, as a ray walks them.
class Writer {
 public:
  Writer(std::span<const BinaryNode> tree, std::span<const Forest> forests, Bvh4& out)
      : tree_(tree), forests_(forests), out_(out) {}

  void run() {
    const Box3 bounds = tree_.size() == 1 ? write({{{0, 0}}, 1}, 1) : write(lanes_of({0, 0}), 1);
    out_.lower = to_vec3(bounds.lower);
    out_.upper = to_vec3(bounds.upper);
  }

 private:
  struct Place {
    std::uint32_t node, first;  ///< in the binary tree; its first triangle
  };
  struct Lanes {
    std::array<Place, 4> place;
    int count = 0;
  };

  Lanes lanes_of(Place parent) const {
    Lanes lanes;
    share_out(parent, forests_[parent.node].left[3], 4, lanes);
    return lanes;
  }
  void share_out(Place p, int left_trees, int trees, Lanes& lanes) const {
    const std::uint32_t left = tree_[p.node].left;
    add_forest({left_child(p.node), p.first}, left_trees, lanes);
    add_forest({right_child(p.node, left), p.first + left}, trees - left_trees, lanes);
  }
  void add_forest(Place p, int trees, Lanes& lanes) const {
    while (trees > 1 && forests_[p.node].left[trees - 1] == 0) --trees;
    if (trees == 1) {
      lanes.place[lanes.count++] = p;
    } else {
      share_out(p, forests_[p.node].left[trees - 1], trees, lanes);
    }
  }

  Box3 write(const Lanes& lanes, int depth) {
    out_.depth = std::max(out_.depth, depth);
    const std::size_t index = out_.nodes.size();
    out_.nodes.emplace_back();
    Box3 bounds = Box3::empty();
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      Box3 box = Box3::empty();
      const ChildRef child = lane < lanes.count ? write_child(lanes.place[lane], depth, box) : kEmptyChild;
      set_lane_box(out_.nodes[index], lane, box);
      out_.nodes[index].child[lane] = child;
      bounds.grow(box);
    }
    return bounds;
  }

  ChildRef write_child(Place p, int depth, Box3& box) {
    const BinaryNode& node = tree_[p.node];
    if (forests_[p.node].left[0] == 0) {
      const int count = static_cast<int>(node.triangles);
      box = box_of_triangles(out_.triangles.data() + p.first, count);
      return make_leaf(p.first, count);
    }
    const auto child = static_cast<ChildRef>(out_.nodes.size());
    box = write(lanes_of(p), depth + 1);
    return child;
  }

  std::span<const BinaryNode> tree_;
  std::span<const Forest> forests_;
  Bvh4& out_;
};

}  // namespace

Bvh4 collapse(std::span<const BinaryNode> tree, std::vector<LeafTriangle> triangles, const BuildOptions& options) {
  std::vector<Forest> forests(tree.size());
  for (std::size_t i = tree.size(); i-- > 0;) {  // children come after their parent
    const auto node = static_cast<std::uint32_t>(i);
    const std::uint32_t left = tree[i].left;
    forests[i] = left == 0
                     ? cheapest_forest(tree[i], nullptr, nullptr, options)
                     : cheapest_forest(tree[i], &forests[left_child(node)], &forests[right_child(node, left)], options);
  }
  Bvh4 bvh;
  bvh.triangles = std::move(triangles);
  bvh.nodes.reserve(tree.size() / 4 + 1);
  Writer(tree, forests, bvh).run();
  return bvh;
}

}  // namespace ctu::accel
