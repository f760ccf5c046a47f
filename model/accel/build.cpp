#include "model/accel/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/accel/build_by.h"
#include "model/accel/collapse.h"
#include "model/accel/leaf_record.h"
#include "model/accel/mesh_check.h"
#include "model/accel/node_box.h"
#include "model/base/error.h"
#include "model/base/parallel.h"

namespace ctu::accel {
namespace {

constexpr std::size_t kChunkTriangles = 16384;

void check(const BuildOptions& o) {
  const char* const where = "BVH build options";
  if (o.max_leaf_triangles < 1 || o.max_leaf_triangles > kMaxLeafTriangles)
    throw Error(where, fmt::format("max_leaf_triangles is {}", o.max_leaf_triangles),
                fmt::format("choose 1 to {}", kMaxLeafTriangles));
  if (o.bins < 2 || o.bins > kMaxBins)
    throw Error(where, fmt::format("bins is {}", o.bins), fmt::format("choose 2 to {}", kMaxBins));
  if (!(o.node_cost > 0 && o.triangle_cost > 0 && std::isfinite(o.node_cost) && std::isfinite(o.triangle_cost)))
    throw Error(where, "node_cost and triangle_cost must be finite and above 0",
                "choose 1 for both, as the paper does");
}

void check_count(std::size_t primitives) {
  if (primitives == 0) throw Error("mesh", "no triangle in it", "give a scene with at least one triangle or sphere");
  if (primitives > kMaxTriangles)
    throw Error("mesh", fmt::format("{} triangles", primitives),
                fmt::format("the unit's child references name at most {}", kMaxTriangles));
}

/// A power of two that brings the scene's extent near 1, so that areas neither overflow nor vanish: the builder
/// compares costs in scaled space. Coordinates stay below 2^60.
float work_scale(const Box3& bounds) {
  alignas(16) float lower[4], upper[4];
  _mm_store_ps(lower, bounds.lower);
  _mm_store_ps(upper, bounds.upper);
  double extent = 0, largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    extent = std::max(extent, static_cast<double>(upper[axis]) - lower[axis]);
    largest =
        std::max({largest, std::fabs(static_cast<double>(lower[axis])), std::fabs(static_cast<double>(upper[axis]))});
  }
  if (extent == 0) extent = largest;
  if (extent == 0) return 1;
  const int exponent = std::min(-std::ilogb(extent), 59 - std::ilogb(largest));
  return std::ldexp(1.0f, std::clamp(exponent, -149, 126));
}

std::unique_ptr<TriangleRef[]> make_refs(const scene::Mesh& mesh, float scale, int threads) {
  auto refs = std::make_unique_for_overwrite<TriangleRef[]>(mesh.primitives());
  parallel_chunks(mesh.primitives(), kChunkTriangles, threads, [&](std::size_t first, std::size_t last) {
    const __m128 factor = _mm_set1_ps(scale);
    for (std::size_t i = first; i < last; ++i) {
      const LeafTriangle record = leaf_record(mesh, static_cast<std::uint32_t>(i));
      Box3 box = box_of_triangles(&record, 1);
      box = {_mm_mul_ps(box.lower, factor), _mm_mul_ps(box.upper, factor)};
      refs[i] = TriangleRef::make(box, static_cast<std::uint32_t>(i));
    }
  });
  return refs;
}

std::vector<LeafTriangle> in_leaf_order(const scene::Mesh& mesh, std::span<const TriangleRef> refs, int threads) {
  std::vector<LeafTriangle> triangles(refs.size());
  parallel_chunks(refs.size(), kChunkTriangles, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) triangles[i] = leaf_record(mesh, refs[i].id());
  });
  return triangles;
}

}  // namespace

BuildInput build_input(const scene::Mesh& mesh, const BuildOptions& options) {
  check(options);
  check_count(mesh.primitives());
  BuildInput input;
  input.scale = work_scale(checked_bounds(mesh, options.threads));
  input.storage = make_refs(mesh, input.scale, options.threads);
  input.refs = {input.storage.get(), mesh.primitives()};
  return input;
}

Bvh4 build_output(const scene::Mesh& mesh, const BuildOptions& options, const BuildInput& input,
                  std::span<const BinaryNode> tree) {
  Bvh4 bvh = collapse(tree, in_leaf_order(mesh, input.refs, options.threads), options);
  bvh.spheres = static_cast<std::uint32_t>(mesh.spheres.size());
  return bvh;
}

Bvh4 build(const scene::Mesh& mesh, const BuildOptions& options) {
  return build_by(mesh, options, [](float) { return SplitHeuristic<SurfaceArea, AllAxes>{}; });
}

}  // namespace ctu::accel
