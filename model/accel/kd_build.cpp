#include "model/accel/kd_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/accel/clip.h"
#include "model/accel/leaf_record.h"
#include "model/accel/mesh_check.h"
#include "model/accel/node_box.h"
#include "model/base/error.h"

namespace ctu::accel {
namespace {

constexpr std::uint32_t kMostReferences = 1u << 30;  // what a node can say

void check(const KdOptions& o) {
  const char* const where = "kd-tree build options";
  if (o.max_leaf_primitives < 1)
    throw Error(where, fmt::format("max_leaf_primitives is {}", o.max_leaf_primitives), "choose 1 or more");
  if (o.max_depth < 0 || o.max_depth > kMostKdDepth)
    throw Error(where, fmt::format("max_depth is {}", o.max_depth), fmt::format("choose 1 to {}", kMostKdDepth));
  if (!(o.traversal_cost > 0 && o.primitive_cost > 0 && std::isfinite(o.traversal_cost) &&
        std::isfinite(o.primitive_cost) && o.empty_bonus >= 0 && o.empty_bonus <= 1))
    throw Error(where, "a cost that is not finite and above 0, or an empty_bonus outside 0 to 1",
                "choose 1, 80 and 0.5, as pbrt does");
}

/// A primitive, or a part of it, on its way into leaves.
struct Reference {
  PrimitiveBox box;
  std::uint32_t id;
};
using References = std::vector<Reference>;

/// Where a box begins or ends on an axis.
struct Edge {
  float at;
  std::uint32_t reference;
  bool ends;
};

/// At one place boxes begin before others end, so that a flat one begins before it ends itself.
bool before(const Edge& a, const Edge& b) {
  if (a.at != b.at) return a.at < b.at;
  if (a.ends != b.ends) return b.ends;
  return a.reference < b.reference;
}

double area(const Vec3& lower, const Vec3& upper) {
  const double x = double{upper.x} - lower.x, y = double{upper.y} - lower.y, z = double{upper.z} - lower.z;
  return 2 * (x * y + y * z + z * x);
}

int longest_axis(const PrimitiveBox& cell) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (double{cell.upper[a]} - cell.lower[a] > double{cell.upper[axis]} - cell.lower[axis]) axis = a;
  return axis;
}

struct Plane {
  int axis = -1;
  std::size_t edge = 0;  ///< its place among the sorted edges of that axis
  double cost = std::numeric_limits<double>::infinity();
};

class Builder {
 public:
  Builder(const KdOptions& options, KdTree& out) : options_(options), out_(out) {}

  void build(References references, const PrimitiveBox& cell, int levels, int bad_planes, int depth) {
    out_.depth = std::max(out_.depth, depth);
    const std::size_t count = references.size();
    if (count <= static_cast<std::size_t>(options_.max_leaf_primitives) || levels == 0) return add_leaf(references);
    const Plane plane = best_plane(references, cell);
    const double leaf_cost = options_.primitive_cost * static_cast<double>(count);
    if (plane.axis >= 0 && plane.cost > leaf_cost) ++bad_planes;
    if (plane.axis < 0 || (plane.cost > 4 * leaf_cost && count < 16) || bad_planes == 3) return add_leaf(references);

    const float at = edges_[plane.edge].at;
    References lower, upper;
    divide(references, plane, lower, upper);
    References().swap(references);
    const std::size_t node = out_.nodes.size();
    out_.nodes.push_back(KdNode::leaf(0, 0));  // its place
    PrimitiveBox below = cell, above = cell;
    below.upper[plane.axis] = above.lower[plane.axis] = at;
    build(std::move(lower), below, levels - 1, bad_planes, depth + 1);
    out_.nodes[node] = KdNode::inner(plane.axis, at, static_cast<std::uint32_t>(out_.nodes.size()));
    build(std::move(upper), above, levels - 1, bad_planes, depth + 1);
  }

 private:
  void add_leaf(const References& references) {
    if (out_.references.size() + references.size() > kMostReferences || out_.nodes.size() >= kMostReferences)
      throw Error("kd-tree", fmt::format("more than {} references or nodes", kMostReferences),
                  "allow more primitives in a leaf or a smaller depth");
    out_.nodes.push_back(KdNode::leaf(static_cast<std::uint32_t>(out_.references.size()),
                                      static_cast<std::uint32_t>(references.size())));
    for (const Reference& r : references) {
      out_.references.push_back(r.id);
      if (options_.clip) out_.boxes.push_back(r.box);
    }
  }

  /// On the longest axis that has a plane inside the cell; `edges_` are then its own.
  Plane best_plane(const References& references, const PrimitiveBox& cell) {
    const int longest = longest_axis(cell);
    for (int turn = 0; turn < 3; ++turn) {
      const int axis = (longest + turn) % 3;
      sort_edges(references, axis);
      const Plane plane = sweep(cell, axis, references.size());
      if (plane.axis >= 0) return plane;
    }
    return {};
  }

  void sort_edges(const References& references, int axis) {
    edges_.clear();
    for (std::uint32_t i = 0; i < references.size(); ++i) {
      edges_.push_back({references[i].box.lower[axis], i, false});
      edges_.push_back({references[i].box.upper[axis], i, true});
    }
    std::sort(edges_.begin(), edges_.end(), before);
  }

  Plane sweep(const PrimitiveBox& cell, int axis, std::size_t count) const {
    const double per_area = 1 / area(cell.lower, cell.upper);
    Plane best;
    if (!std::isfinite(per_area)) return best;
    std::size_t below = 0, above = count;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const Edge& edge = edges_[i];
      above -= edge.ends;
      if (edge.at > cell.lower[axis] && edge.at < cell.upper[axis]) {
        Vec3 upper = cell.upper, lower = cell.lower;
        upper[axis] = lower[axis] = edge.at;
        const double share_below = area(cell.lower, upper) * per_area, share_above = area(lower, cell.upper) * per_area;
        const double bonus = below == 0 || above == 0 ? options_.empty_bonus : 0;
        const double cost = options_.traversal_cost +
                            options_.primitive_cost * (1 - bonus) *
                                (share_below * static_cast<double>(below) + share_above * static_cast<double>(above));
        if (cost < best.cost) best = {axis, i, cost};
      }
      below += !edge.ends;
    }
    return best;
  }

  /// A box that begins before the plane's edge goes below, one that ends after it above; either has its parts there.
  void divide(const References& references, const Plane& plane, References& lower, References& upper) const {
    const float at = edges_[plane.edge].at;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const Edge& edge = edges_[i];
      if (i < plane.edge && !edge.ends) add_side(references[edge.reference], plane.axis, at, Side::Lower, lower);
      if (i > plane.edge && edge.ends) add_side(references[edge.reference], plane.axis, at, Side::Upper, upper);
    }
  }

  void add_side(const Reference& r, int axis, float plane, Side side, References& out) const {
    const bool crosses = r.box.lower[axis] < plane && r.box.upper[axis] > plane;
    if (!options_.clip || !crosses) return out.push_back(r);
    if (const auto part = clipped_box(out_.primitives[r.id], r.box, axis, plane, side)) out.push_back({*part, r.id});
  }

  const KdOptions& options_;
  KdTree& out_;
  std::vector<Edge> edges_;
};

}  // namespace

int default_kd_depth(std::size_t primitives) {
  const double levels = std::round(std::log2(static_cast<double>(std::max<std::size_t>(primitives, 1))));
  return static_cast<int>(std::floor(8 + 1.3 * levels + 0.499));
}

KdTree build_kd_tree(const scene::Mesh& mesh, const KdOptions& options) {
  check(options);
  if (mesh.primitives() == 0) throw Error("mesh", "no triangle in it", "give a scene with at least one primitive");
  const Box3 bounds = checked_bounds(mesh, 1);
  KdTree tree;
  tree.clipped = options.clip;
  tree.lower = to_vec3(bounds.lower);
  tree.upper = to_vec3(bounds.upper);
  tree.spheres = static_cast<std::uint32_t>(mesh.spheres.size());
  References references;
  for (std::uint32_t id = 0; id < mesh.primitives(); ++id) {
    tree.primitives.push_back(leaf_record(mesh, id));
    references.push_back({box_of_primitive(tree.primitives.back()), id});
    if (!options.clip) tree.boxes.push_back(references.back().box);
  }
  const int levels = options.max_depth != 0 ? options.max_depth : default_kd_depth(mesh.primitives());
  Builder(options, tree).build(std::move(references), {tree.lower, tree.upper}, levels, 0, 1);
  return tree;
}

KdStatistics statistics(const KdTree& tree) {
  KdStatistics s;
  s.nodes = tree.nodes.size();
  s.references = tree.references.size();
  s.box_bytes = tree.boxes.size() * sizeof(PrimitiveBox);
  for (const KdNode& node : tree.nodes) {
    if (!node.is_leaf()) continue;
    ++s.leaves;
    s.empty_leaves += node.references() == 0;
    s.longest_leaf = std::max<std::uint64_t>(s.longest_leaf, node.references());
  }
  return s;
}

}  // namespace ctu::accel
