#include "model/reference/selecting_traversal.h"

#include <cmath>
#include <limits>

namespace ctu::reference {
namespace {

using intersect::Hit;
using intersect::Ray;

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

SelectingTraversal::SelectingTraversal(const influence::TreeSet& trees)
    : trees_(trees),
      no_culling_(cull::Design::None, {}),
      bounds_(one_box(trees.global().lower, trees.global().upper)),
      global_(trees.global(), nullptr, no_culling_) {
  for (std::size_t i = 0; i < trees.areas().size(); ++i) local_.emplace_back(trees.local(i), nullptr, no_culling_);
}

bool SelectingTraversal::is_final(const influence::PreparedArea& area, const Ray& ray, const Hit& hit) const {
  if (hit.primitive != intersect::kNoPrimitive)
    return ray.kind == intersect::RayKind::AnyHit || area.certainly_contains(ray, hit.t);
  intersect::SlabTimes times;
  intersect::slab_test_outer(intersect::prepare_ray(ray), bounds_, ray.tmax, times);
  if ((times.hit & 1) == 0) return true;  // the scene is nowhere on its way
  return std::isfinite(times.t1[0]) && area.certainly_contains(ray, times.t1[0]);
}

Hit SelectingTraversal::trace(const Ray& ray, SelectionRecord* record) const {
  if (record != nullptr) ++record->rays;
  if (!intersect::is_valid(ray)) return global_.trace(ray, record != nullptr ? &record->global : nullptr);
  const auto area = trees_.area_of(ray, record != nullptr ? &record->areas_asked : nullptr);
  if (!area) return global_.trace(ray, record != nullptr ? &record->global : nullptr);
  const Hit local = local_[*area].trace(ray, record != nullptr ? &record->local : nullptr);
  const bool final = is_final(trees_.areas()[*area], ray, local);
  if (record != nullptr) {
    ++record->affine;
    record->final += final ? 1 : 0;
  }
  return final ? local : global_.trace(ray, record != nullptr ? &record->global : nullptr, &local);
}

}  // namespace ctu::reference
