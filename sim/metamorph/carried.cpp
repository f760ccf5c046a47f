#include "sim/metamorph/carried.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "model/numeric/round.h"

namespace ctu::sim::metamorph {
namespace {

using intersect::Box4;
using intersect::kLanes;

/// Empty lanes, of infinite bounds the wrong way round, stay what they are.
Box4 carried(const Box4& boxes, const Transformation& t) {
  Box4 image;
  for (int lane = 0; lane < kLanes; ++lane) {
    const Vec3 lower{boxes.lo[0][lane], boxes.lo[1][lane], boxes.lo[2][lane]};
    const Vec3 upper{boxes.hi[0][lane], boxes.hi[1][lane], boxes.hi[2][lane]};
    const Vec3 from_lower = t.point(lower), from_upper = t.point(upper);
    for (int axis = 0; axis < 3; ++axis) {
      const bool mirrored = t.sign[static_cast<std::size_t>(axis)] < 0;
      image.lo[axis][lane] = mirrored ? from_upper[axis] : from_lower[axis];
      image.hi[axis][lane] = mirrored ? from_lower[axis] : from_upper[axis];
    }
  }
  return image;
}

/// The number that each cell of R^3 has in the image.
std::vector<int> carried_cells(int resolution, const Transformation& t) {
  const int r = resolution;
  std::vector<int> image(static_cast<std::size_t>(r * r * r));
  for (int cell = 0; cell < r * r * r; ++cell) {
    const int index[3] = {cell % r, cell / r % r, cell / (r * r)};
    int to[3];
    for (std::size_t a = 0; a < 3; ++a) to[a] = t.sign[a] < 0 ? r - 1 - index[t.from[a]] : index[t.from[a]];
    image[static_cast<std::size_t>(cell)] = cull::cell_bit(r, to[0], to[1], to[2]);
  }
  return image;
}

bool same_bits(const Vec3& a, const Vec3& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (numeric::bits(a[axis]) != numeric::bits(b[axis])) return false;
  return true;
}

bool same_node(const accel::Node4& a, const accel::Node4& b) {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (a.child[lane] != b.child[lane]) return false;
    for (int axis = 0; axis < 3; ++axis)
      if (numeric::bits(a.boxes.lo[axis][lane]) != numeric::bits(b.boxes.lo[axis][lane]) ||
          numeric::bits(a.boxes.hi[axis][lane]) != numeric::bits(b.boxes.hi[axis][lane]))
        return false;
  }
  return true;
}

bool same_triangle(const accel::LeafTriangle& a, const accel::LeafTriangle& b) {
  return a.primitive == b.primitive && same_bits(a.v0, b.v0) && same_bits(a.v1, b.v1) && same_bits(a.v2, b.v2);
}

}  // namespace

accel::Bvh4 carried(const accel::Bvh4& bvh, const Transformation& transformation) {
  assert(transformation.is_exact());
  accel::Bvh4 image = bvh;
  for (accel::Node4& node : image.nodes) node.boxes = carried(node.boxes, transformation);
  for (accel::LeafTriangle& triangle : image.triangles) {
    triangle.v0 = transformation.point(triangle.v0);
    triangle.v1 = transformation.point(triangle.v1);
    triangle.v2 = transformation.point(triangle.v2);
  }
  const Vec3 a = transformation.point(bvh.lower), b = transformation.point(bvh.upper);
  for (int axis = 0; axis < 3; ++axis) {
    image.lower[axis] = std::min(a[axis], b[axis]);
    image.upper[axis] = std::max(a[axis], b[axis]);
  }
  return image;
}

cull::ObjectMasks carried(const cull::ObjectMasks& masks, const Transformation& transformation) {
  assert(masks.index.empty());
  const std::vector<int> cells = carried_cells(masks.resolution, transformation);
  const auto words = static_cast<std::size_t>(masks.words);
  cull::ObjectMasks image = masks;
  std::fill(image.bits.begin(), image.bits.end(), 0);
  for (std::size_t first = 0; first < masks.bits.size(); first += words)
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const auto to = static_cast<std::size_t>(cells[cell]);
      image.bits[first + to / 64] |= (masks.bits[first + cell / 64] >> (cell % 64) & 1) << (to % 64);
    }
  return image;
}

bool same_tree(const accel::Bvh4& a, const accel::Bvh4& b) {
  return a.depth == b.depth && same_bits(a.lower, b.lower) && same_bits(a.upper, b.upper) &&
         std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), same_node) &&
         std::equal(a.triangles.begin(), a.triangles.end(), b.triangles.begin(), b.triangles.end(), same_triangle);
}

}  // namespace ctu::sim::metamorph
