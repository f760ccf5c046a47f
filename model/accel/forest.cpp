#include "model/accel/forest.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::accel {

void append_tree(Bvh4& trees, const Bvh4& tree) {
  if (trees.trees() >= kMostTrees)
    throw Error("trees", fmt::format("more than {}", kMostTrees), "give rays fewer trees of their own");
  if (trees.triangles.size() + tree.triangles.size() > kMaxTriangles)
    throw Error("trees", fmt::format("of {} primitives in all", trees.triangles.size() + tree.triangles.size()),
                fmt::format("give rays fewer trees of their own; {} primitives can be named", kMaxTriangles));
  const auto first_node = static_cast<ChildRef>(trees.nodes.size());
  const auto first_triangle = static_cast<std::uint32_t>(trees.triangles.size());
  trees.further_roots.push_back(first_node);
  for (Node4 node : tree.nodes) {
    for (ChildRef& child : node.child)
      if (is_leaf(child))
        child = make_leaf(leaf_first(child) + first_triangle, leaf_count(child));
      else if (is_inner(child))
        child += first_node;
    trees.nodes.push_back(node);
  }
  trees.triangles.insert(trees.triangles.end(), tree.triangles.begin(), tree.triangles.end());
  trees.spheres += tree.spheres;
  trees.depth = std::max(trees.depth, tree.depth);
}

}  // namespace ctu::accel
