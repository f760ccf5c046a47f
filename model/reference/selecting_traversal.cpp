#include "model/reference/selecting_traversal.h"

namespace ctu::reference {
namespace {

using intersect::Hit;
using intersect::Ray;

}  // namespace

SelectingTraversal::SelectingTraversal(const influence::TreeSet& trees)
    : trees_(trees),
      no_culling_(cull::Design::None, {}),
      choice_(trees),
      global_(trees.global(), nullptr, no_culling_) {
  for (std::size_t i = 0; i < trees.areas().size(); ++i) local_.emplace_back(trees.local(i), nullptr, no_culling_);
}

bool SelectingTraversal::is_final(const influence::PreparedArea& area, const Ray& ray, const Hit& hit) const {
  if (hit.primitive != intersect::kNoPrimitive)
    return ray.kind == intersect::RayKind::AnyHit || area.certainly_contains(ray, hit.t);
  return choice_.ends_in(area, ray);
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
