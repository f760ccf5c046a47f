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

influence::TreeSet trees_for(const scene::Scene& scene, const std::vector<intersect::Ray>& shadow,
                             const accel::Bvh4& global, const RayTrees& trees, const accel::BuildOptions& build) {
  check(trees);
  influence::FindOptions find;
  find.most_areas = trees.most_areas;
  const auto found = influence::find_areas(shadow, scene.lower, scene.upper, find);
  influence::TreeSetOptions options;
  options.build = build;
  return influence::TreeSet(scene.mesh, global, found.list(), options);
}

/// Tests of the ray from the root of a tree on.
std::uint32_t tests_of(const reference::Traversal& traversal, std::uint32_t tree, const intersect::Ray& ray) {
  reference::StepList walk;
  traversal.trace_in(tree, ray, &walk);
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
    : LocalTrees(scene, shadow_rays(generator, global), global, options, build) {}

LocalTrees::LocalTrees(const scene::Scene& scene, const std::vector<intersect::Ray>& shadow, const accel::Bvh4& global,
                       const RayTrees& options, const accel::BuildOptions& build)
    : trees_(trees_for(scene, shadow, global, options, build)), choice_(trees_), kept_(worth_keeping(shadow)) {}

std::vector<std::uint32_t> LocalTrees::worth_keeping(const std::vector<intersect::Ray>& shadow) const {
  const cull::MaskTester no_culling(cull::Design::None, {});
  const reference::Traversal global(trees_.global(), nullptr, no_culling);
  std::vector<reference::Traversal> local;
  for (std::size_t area = 0; area < trees_.areas().size(); ++area)
    local.emplace_back(trees_.local(area), nullptr, no_culling);
  std::vector<std::int64_t> saved(local.size());
  for (const intersect::Ray& ray : shadow)
    if (const auto area = choice_.area_of(ray))
      saved[*area] += std::int64_t{tests_of(global, 0, ray)} - std::int64_t{tests_of(local[*area], 0, ray)};
  std::vector<std::uint32_t> kept;
  for (std::uint32_t area = 0; area < saved.size(); ++area)
    if (saved[area] > 0) kept.push_back(area);
  return kept;
}

std::vector<reference::RayTree> LocalTrees::choose(const reference::Traversal& traversal,
                                                   const std::vector<intersect::Ray>& rays) const {
  std::vector<reference::RayTree> chosen;
  chosen.reserve(rays.size());
  for (const intersect::Ray& ray : rays) {
    const std::uint32_t global_tests = tests_of(traversal, 0, ray);
    const std::optional<std::uint32_t> area = choice_.area_of(ray);
    const auto place = area ? std::lower_bound(kept_.begin(), kept_.end(), *area) : kept_.end();
    if (place == kept_.end() || *place != *area) {
      chosen.push_back({0, global_tests, global_tests});
      continue;
    }
    const auto tree = static_cast<std::uint8_t>(place - kept_.begin() + 1);
    chosen.push_back({tree, tests_of(traversal, tree, ray), global_tests});
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
