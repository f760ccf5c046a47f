#include "sim/check/naive_test.h"

#include <cmath>
#include <utility>

namespace ctu::sim::check {
namespace {

struct NaiveBox {
  float lower[3], upper[3];
};

struct Interval {
  float from, to;
};

/// Kay and Kajiya 1986 with reciprocals, as renderers have it (Williams, Barrus, Morley, Shirley 2005): a comparison
/// with 0 times infinity is false and leaves the interval as it was.
Interval slab_interval(const intersect::Ray& ray, const NaiveBox& box) {
  Interval t{ray.tmin, ray.tmax};
  for (int a = 0; a < 3; ++a) {
    const float reciprocal = 1.0f / ray.direction[a];
    float near = (box.lower[a] - ray.origin[a]) * reciprocal, far = (box.upper[a] - ray.origin[a]) * reciprocal;
    if (std::signbit(reciprocal)) std::swap(near, far);
    if (near > t.from) t.from = near;
    if (far < t.to) t.to = far;
  }
  return t;
}

/// Algorithm 1's index on one axis, clamped at both ends; a flat axis, 0 times infinity, is cell 0.
int cell_of(float point, float lower, float upper, int resolution) {
  const float r = static_cast<float>(resolution);
  const float cell = std::floor(r / (upper - lower) * (point - lower));
  if (!(cell > 0)) return 0;
  return cell < r ? static_cast<int>(cell) : resolution - 1;
}

}  // namespace

bool NaiveTest::shares_a_cell(cull::CellKey key, std::uint32_t node, int lane) const {
  std::uint64_t ray_mask[cull::words_per_mask(cull::kMaxResolution)];
  table_.ray_mask(key, ray_mask);
  const std::uint64_t* mask = masks_.mask(node, lane);
  std::uint64_t both = 0;
  for (int w = 0; w < masks_.words; ++w) both |= ray_mask[w] & mask[w];
  return both != 0;
}

LaneSets NaiveTest::operator()(const intersect::Ray& ray, std::uint32_t node) const {
  const accel::Node4& at = bvh_.nodes[node];
  LaneSets lanes;
  for (int lane = 0; lane < intersect::kLanes; ++lane) {
    if (at.child[lane] == accel::kEmptyChild) continue;
    NaiveBox box;
    float side = 0;
    for (int a = 0; a < 3; ++a) side = std::fmax(side, at.boxes.hi[a][lane] - at.boxes.lo[a][lane]);
    for (int a = 0; a < 3; ++a) {
      box.lower[a] = at.boxes.lo[a][lane] - padding_.box * side;
      box.upper[a] = at.boxes.hi[a][lane] + padding_.box * side;
    }
    Interval t = slab_interval(ray, box);
    t.from -= padding_.times * std::fabs(t.from);
    if (t.to < INFINITY) t.to += padding_.times * std::fabs(t.to);
    if (!(t.from <= t.to)) continue;
    lanes.hit = static_cast<std::uint8_t>(lanes.hit | 1u << lane);
    cull::CellKey key;
    for (int a = 0; a < 3; ++a) {
      const float lower = at.boxes.lo[a][lane], upper = at.boxes.hi[a][lane];
      const float begin = ray.origin[a] + t.from * ray.direction[a], end = ray.origin[a] + t.to * ray.direction[a];
      key.set(a, cell_of(begin, lower, upper, table_.ray_resolution()),
              cell_of(end, lower, upper, table_.ray_resolution()));
    }
    if (shares_a_cell(key, node, lane)) lanes.pass = static_cast<std::uint8_t>(lanes.pass | 1u << lane);
  }
  return lanes;
}

}  // namespace ctu::sim::check
