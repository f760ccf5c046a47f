#include "traces/local_trees.h"

#include <algorithm>

#include <fmt/format.h>

#include "model/accel/forest.h"
#include "model/base/error.h"
#include "model/influence/find_areas.h"

namespace ctu::traces {
namespace {

constexpr std::uint64_t kPathRanges = 64, kRaysLookedAt = 1u << 14;

/// Shadow rays of paths spread evenly.
std::vector<intersect::Ray> shadow_rays(const RayGenerator& generator, const accel::Bvh4& global) {
  const cull::MaskTester no_culling(cull::Design::None, {});
  const reference::Traversal traversal(global, nullptr, no_culling);
  const auto closest = [&](const intersect::Ray& ray, bool) { return traversal.trace(ray); };
  const std::uint64_t paths = generator.paths(), ranges = std::min(kPathRanges, paths);
  const std::uint64_t length = std::min(paths / ranges, kRaysLookedAt / kPathRanges);
  std::vector<intersect::Ray> shadow;
  for (std::uint64_t range = 0; range < ranges; ++range) {
    const std::uint64_t first = range * paths / ranges;
    std::vector<intersect::Ray> rays;
    std::vector<intersect::Hit> hits;
    generator.generate(first, first + length, closest, rays, hits);
    std::copy_if(rays.begin(), rays.end(), std::back_inserter(shadow),
                 [](const intersect::Ray& ray) { return ray.kind == intersect::RayKind::AnyHit; });
  }
  return shadow;
}

influence::TreeSet trees_for(const scene::Scene& scene, const RayGenerator& generator, const accel::Bvh4& global,
                             const RayTrees& trees, const accel::BuildOptions& build) {
  check(trees);
  influence::FindOptions find;
  find.most_areas = trees.most_areas;
  const auto found = influence::find_areas(shadow_rays(generator, global), scene.lower, scene.upper, find);
  influence::TreeSetOptions options;
  options.build = build;
  return influence::TreeSet(scene.mesh, global, found.list(), options);
}

std::uint32_t tests_of(const reference::StepList& walk) {
  return static_cast<std::uint32_t>(reference::count_steps(walk, 0, walk.rays()).intersections());
}

}  // namespace

void check(const RayTrees& trees) {
  constexpr int kMost = static_cast<int>(accel::kMostTrees) - 1;
  if (trees.most_areas < 0 || trees.most_areas > kMost)
    throw Error("local trees", fmt::format("{} of them", trees.most_areas),
                fmt::format("give 1 to {}, or 0 for none", kMost));
}

LocalTrees::LocalTrees(const scene::Scene& scene, const RayGenerator& generator, const accel::Bvh4& global,
                       const RayTrees& options, const accel::BuildOptions& build)
    : trees_(trees_for(scene, generator, global, options, build)), choice_(trees_) {}

std::vector<reference::RayTree> LocalTrees::choose(const reference::Traversal& traversal,
                                                   const std::vector<intersect::Ray>& rays) const {
  std::vector<reference::RayTree> chosen;
  chosen.reserve(rays.size());
  reference::StepList walk;
  for (const intersect::Ray& ray : rays) {
    const std::optional<std::uint32_t> area = choice_.area_of(ray);
    walk.clear();
    traversal.trace_in(0, ray, &walk);
    const std::uint32_t global_tests = tests_of(walk);
    if (!area) {
      chosen.push_back({0, global_tests, global_tests});
      continue;
    }
    walk.clear();
    traversal.trace_in(*area + 1, ray, &walk);
    chosen.push_back({static_cast<std::uint8_t>(*area + 1), tests_of(walk), global_tests});
  }
  return chosen;
}

void put_trees_together(const std::vector<reference::RayTree>& trees, int window, std::vector<std::uint32_t>& order) {
  const auto step = static_cast<std::size_t>(window);
  for (std::size_t begin = 0; begin < order.size(); begin += step) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(std::min(begin + step, order.size()));
    std::stable_sort(first, last, [&](std::uint32_t a, std::uint32_t b) { return trees[a].tree < trees[b].tree; });
  }
}

}  // namespace ctu::traces
