#include "model/reference/tree_choice.h"

#include <cmath>
#include <limits>

#include "model/intersect/slab_test.h"

namespace ctu::reference {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

intersect::Box4 one_box(const Vec3& lower, const Vec3& upper) {
  intersect::Box4 boxes;
  for (int axis = 0; axis < 3; ++axis)
    for (int lane = 0; lane < intersect::kLanes; ++lane) {
      boxes.lo[axis][lane] = lane == 0 ? lower[axis] : kInfinity;
      boxes.hi[axis][lane] = lane == 0 ? upper[axis] : -kInfinity;
    }
  return boxes;
}

}  // namespace

TreeChoice::TreeChoice(const influence::TreeSet& trees)
    : trees_(trees), bounds_(one_box(trees.global().lower, trees.global().upper)) {}

bool TreeChoice::ends_in(const influence::PreparedArea& area, const intersect::Ray& ray) const {
  intersect::SlabTimes times;
  intersect::slab_test_outer(intersect::prepare_ray(ray), bounds_, ray.tmax, times);
  if ((times.hit & 1) == 0) return true;  // the scene is nowhere on its way
  return std::isfinite(times.t1[0]) && area.certainly_contains(ray, times.t1[0]);
}

std::optional<std::uint32_t> TreeChoice::area_of(const intersect::Ray& ray) const {
  if (!intersect::is_valid(ray)) return std::nullopt;
  const std::optional<std::uint32_t> area = trees_.area_of(ray);
  if (area && !ends_in(trees_.areas()[*area], ray)) return std::nullopt;
  return area;
}

}  // namespace ctu::reference
