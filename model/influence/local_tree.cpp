#include "model/influence/local_tree.h"

#include <fmt/format.h>

#include "model/accel/build_by.h"
#include "model/accel/leaf_record.h"
#include "model/accel/mesh_check.h"
#include "model/accel/primitive_box.h"
#include "model/base/error.h"
#include "model/base/parallel.h"
#include "model/influence/projected_area.h"

namespace ctu::influence {
namespace {

constexpr std::size_t kChunkTriangles = 4096;

template <class Chance, class Axes>
accel::Bvh4 build_with(const scene::Mesh& mesh, const accel::BuildOptions& options, const Chance& chance_at,
                       const Axes& axes_at) {
  return accel::build_by(mesh, options, [&](float scale) {
    using Heuristic = accel::SplitHeuristic<decltype(chance_at(scale)), decltype(axes_at(scale))>;
    return Heuristic{chance_at(scale), axes_at(scale)};
  });
}

template <class Chance>
accel::Bvh4 build_with(const scene::Mesh& mesh, const InfluenceArea& area, const TreeHeuristic& heuristic,
                       const accel::BuildOptions& options, const Chance& chance_at) {
  switch (heuristic.axes) {
    case TreeAxes::All:
      return build_with(mesh, options, chance_at, [](float) { return accel::AllAxes{}; });
    case TreeAxes::Longest:
      return build_with(mesh, options, chance_at, [](float) { return accel::LongestAxis{}; });
    case TreeAxes::LeastFacing:
      break;
  }
  return build_with(mesh, options, chance_at,
                    [&](float scale) { return LeastFacingAxes(area, scale, heuristic.thresholds); });
}

bool may_touch(const scene::Mesh& mesh, const PreparedArea& area, std::size_t primitive) {
  if (primitive < mesh.triangles.size()) {
    const auto& [a, b, c] = mesh.triangles[primitive];
    return area.may_touch(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  }
  const accel::PrimitiveBox box = accel::box_of_primitive(accel::leaf_record(mesh, std::uint32_t(primitive)));
  return area.may_touch(box.lower, box.upper);
}

}  // namespace

std::string to_string(const TreeHeuristic& heuristic) {
  const char* const axes = heuristic.axes == TreeAxes::All       ? "all axes"
                           : heuristic.axes == TreeAxes::Longest ? "LSPH"
                                                                 : "SPFH";
  const char* const cost = heuristic.cost == TreeCost::SurfaceArea     ? "SAH"
                           : heuristic.cost == TreeCost::ProjectedArea ? "PAH"
                                                                       : "mixed";
  return fmt::format("{} + {}", axes, cost);
}

std::vector<std::uint32_t> primitives_in(const scene::Mesh& mesh, const PreparedArea& area, int threads) {
  std::vector<std::uint8_t> touches(mesh.primitives());
  parallel_chunks(touches.size(), kChunkTriangles, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) touches[i] = may_touch(mesh, area, i) ? 1 : 0;
  });
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < touches.size(); ++i)
    if (touches[i] != 0) ids.push_back(i);
  return ids;
}

accel::Bvh4 build_for(const scene::Mesh& mesh, const InfluenceArea& area, const TreeHeuristic& heuristic,
                      const accel::BuildOptions& options) {
  if (heuristic.cost == TreeCost::SurfaceArea)
    return build_with(mesh, area, heuristic, options, [](float) { return accel::SurfaceArea{}; });
  if (heuristic.cost == TreeCost::ProjectedArea)
    return build_with(mesh, area, heuristic, options, [&](float scale) { return ProjectedArea(area, scale); });
  const accel::Box3 bounds = accel::checked_bounds(mesh, options.threads);
  return build_with(mesh, area, heuristic, options, [&](float scale) {
    const __m128 factor = _mm_set1_ps(scale);
    const accel::Box3 root{_mm_mul_ps(bounds.lower, factor), _mm_mul_ps(bounds.upper, factor)};
    return MixedArea(ProjectedArea(area, scale), heuristic.surface_part, accel::half_area(root));
  });
}

accel::Bvh4 build_for(const scene::Mesh& mesh, const std::vector<std::uint32_t>& primitives, const InfluenceArea& area,
                      const TreeHeuristic& heuristic, const accel::BuildOptions& options) {
  scene::Mesh part;
  part.vertices = mesh.vertices;
  const std::size_t triangles = mesh.triangles.size();
  for (const std::uint32_t id : primitives)
    if (id < triangles)
      part.triangles.push_back(mesh.triangles[id]);
    else
      part.spheres.push_back(mesh.spheres[id - triangles]);
  accel::Bvh4 bvh = build_for(part, area, heuristic, options);
  for (accel::LeafTriangle& primitive : bvh.triangles)
    primitive.primitive = primitives[primitive.id()] | (primitive.primitive & accel::LeafTriangle::kSphereBit);
  return bvh;
}

}  // namespace ctu::influence
