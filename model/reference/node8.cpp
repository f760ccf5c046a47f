#include "model/reference/node8.h"

#include <limits>

namespace ctu::reference {
namespace {

using accel::ChildRef;

/// A child of some 4-wide node.
struct Child {
  const accel::Node4* node;
  int lane;

  ChildRef ref() const { return node->child[lane]; }
  double half_area() const {
    double extent[3];
    for (int axis = 0; axis < 3; ++axis)
      extent[axis] = static_cast<double>(node->boxes.hi[axis][lane]) - node->boxes.lo[axis][lane];
    return extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0];
  }
};

int filled_lanes(const accel::Node4& node) {
  int count = 0;
  while (count < intersect::kLanes && node.child[count] != accel::kEmptyChild) ++count;
  return count;
}

class Widener {
 public:
  explicit Widener(const accel::Bvh4& bvh) : bvh_(bvh) {}

  std::vector<Node8> run() {
    nodes_.reserve(bvh_.nodes.size() / 2 + 1);
    write(0);
    return std::move(nodes_);
  }

 private:
  /// The largest inner child whose children fit in its place; -1 if there is none.
  int to_open(const std::vector<Child>& lanes) const {
    int best = -1;
    double best_area = -1;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      if (!accel::is_inner(lanes[i].ref())) continue;
      const auto opened = static_cast<int>(lanes.size()) - 1 + filled_lanes(bvh_.nodes[lanes[i].ref()]);
      const double area = lanes[i].half_area();
      if (opened > kWideLanes || !(area > best_area)) continue;
      best = static_cast<int>(i);
      best_area = area;
    }
    return best;
  }

  void add_children(ChildRef ref, std::vector<Child>& lanes) const {
    const accel::Node4& node = bvh_.nodes[ref];
    for (int lane = 0; lane < filled_lanes(node); ++lane) lanes.push_back({&node, lane});
  }

  ChildRef write(ChildRef ref) {
    std::vector<Child> lanes;
    add_children(ref, lanes);
    for (int open = to_open(lanes); open >= 0; open = to_open(lanes)) {
      const ChildRef opened = lanes[static_cast<std::size_t>(open)].ref();
      lanes.erase(lanes.begin() + open);
      add_children(opened, lanes);
    }
    const std::size_t index = nodes_.size();
    nodes_.push_back(boxes_of(lanes));
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const ChildRef child = lanes[i].ref();
      const ChildRef written = accel::is_inner(child) ? write(child) : child;
      nodes_[index].child[i] = written;
    }
    return static_cast<ChildRef>(index);
  }

  static Node8 boxes_of(const std::vector<Child>& lanes) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Node8 node;
    for (std::size_t i = 0; i < kWideLanes; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        node.lo[axis][i] = i < lanes.size() ? lanes[i].node->boxes.lo[axis][lanes[i].lane] : kInfinity;
        node.hi[axis][i] = i < lanes.size() ? lanes[i].node->boxes.hi[axis][lanes[i].lane] : -kInfinity;
      }
      node.child[i] = accel::kEmptyChild;
    }
    return node;
  }

  const accel::Bvh4& bvh_;
  std::vector<Node8> nodes_;
};

}  // namespace

std::vector<Node8> widen(const accel::Bvh4& bvh) { return Widener(bvh).run(); }

}  // namespace ctu::reference
