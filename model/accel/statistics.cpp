#include "model/accel/statistics.h"

namespace ctu::accel {
namespace {

double area(double x, double y, double z) { return 2 * (x * y + y * z + z * x); }

}  // namespace

double surface_area(const intersect::Box4& boxes, int lane) {
  double extent[3];
  for (int axis = 0; axis < 3; ++axis) extent[axis] = static_cast<double>(boxes.hi[axis][lane]) - boxes.lo[axis][lane];
  return area(extent[0], extent[1], extent[2]);
}

double surface_area(const Vec3& lower, const Vec3& upper) {
  return area(static_cast<double>(upper.x) - lower.x, static_cast<double>(upper.y) - lower.y,
              static_cast<double>(upper.z) - lower.z);
}

TreeStatistics statistics(const Bvh4& bvh, double node_cost, double triangle_cost) {
  TreeStatistics s;
  s.nodes = bvh.nodes.size();
  s.triangles = bvh.triangles.size();
  s.depth = bvh.depth;
  double node_area = 0, triangle_area = 0;
  for (const Node4& node : bvh.nodes) {
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      const ChildRef child = node.child[lane];
      if (child == kEmptyChild) continue;
      ++s.filled_lanes;
      const double a = surface_area(node.boxes, lane);
      if (is_leaf(child)) {
        ++s.leaves;
        ++s.leaves_of_size[leaf_count(child)];
        triangle_area += a * leaf_count(child);
      } else {
        node_area += a;
      }
    }
  }
  const double root = surface_area(bvh.lower, bvh.upper);
  if (root > 0) s.sah_cost = (node_cost * (root + node_area) + triangle_cost * triangle_area) / root;
  return s;
}

}  // namespace ctu::accel
