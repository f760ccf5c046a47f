#include "model/influence/tree_set.h"

#include <cmath>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/scene/vector64.h"

namespace ctu::influence {
namespace {

using scene::Vector64;

constexpr double kDegree = 3.14159265358979323846 / 180;

std::size_t bytes_of(const accel::Bvh4& bvh) {
  return bvh.nodes.size() * sizeof(accel::Node4) + bvh.triangles.size() * sizeof(accel::LeafTriangle);
}

}  // namespace

bool runs_along(const InfluenceArea& area, const intersect::Ray& ray, double least_cosine) {
  const Vector64 d(ray.direction);
  const Vector64 field =
      area.kind == AreaKind::Point ? Vector64(ray.origin) - Vector64(area.origin) : Vector64(area.axes[2]);
  return std::fabs(scene::dot(d, field)) >= least_cosine * scene::length(d) * scene::length(field);
}

TreeSet::TreeSet(const scene::Mesh& mesh, accel::Bvh4 global, const std::vector<InfluenceArea>& areas,
                 const TreeSetOptions& options)
    : global_(std::move(global)), least_cosine_(std::cos(options.tolerance_degrees * kDegree)) {
  if (!(options.tolerance_degrees >= 0 && options.tolerance_degrees <= 90))
    throw Error("affinity", fmt::format("a tolerance of {} degrees", options.tolerance_degrees), "give 0 to 90");
  for (const InfluenceArea& area : areas) {
    PreparedArea prepared(area);
    const std::vector<std::uint32_t> primitives = primitives_in(mesh, prepared, options.build.threads);
    if (primitives.empty()) continue;
    local_.push_back(build_for(mesh, primitives, area, options.local, options.build));
    areas_.push_back(std::move(prepared));
  }
  octree_ = AreaOctree(areas_, global_.lower, global_.upper, options.octree_levels);
}

std::optional<std::uint32_t> TreeSet::area_of(const intersect::Ray& ray, std::uint64_t* asked) const {
  if (ray.tmin < 0) return std::nullopt;  // a part of it lies before its origin
  for (const std::uint32_t i : octree_.at(ray.origin)) {
    if (asked != nullptr) ++*asked;
    if (runs_along(areas_[i].area(), ray, least_cosine_) && areas_[i].certainly_contains(ray.origin)) return i;
  }
  return std::nullopt;
}

double TreeSet::memory_ratio() const {
  std::size_t bytes = bytes_of(global_);
  for (const accel::Bvh4& local : local_) bytes += bytes_of(local);
  return double(bytes) / double(bytes_of(global_));
}

}  // namespace ctu::influence
