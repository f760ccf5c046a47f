#include "sim/paper/raydist_octree.h"

#include "model/influence/octree.h"
#include "model/scene/random.h"
#include "sim/stopwatch.h"

namespace ctu::sim::paper {
namespace {

using influence::AreaKind;
using influence::InfluenceArea;
using influence::PreparedArea;

constexpr int kCounts[] = {1, 2, 4, 8, 16, 32, 64};
constexpr int kPoints = 20000;
constexpr std::uint32_t kAreaStream = 1, kPointStream = 2;

InfluenceArea random_area(scene::Random& random) {
  InfluenceArea area;
  area.kind = random.unit() < 0.5 ? AreaKind::Plane : AreaKind::Point;
  area.origin = (random.in_ball() * 0.8).rounded();
  area.axes = influence::frame_along(random.direction().rounded(), random.direction().rounded());
  area.half_x = static_cast<float>(random.between(0.15, 0.35));
  area.half_y = static_cast<float>(random.between(0.15, 0.35));
  area.near = static_cast<float>(random.between(0, 0.1));
  area.far = static_cast<float>(random.between(0.8, 1.2));
  return area;
}

/// Sums, over the points, the numbers of the areas that contain each: by `candidates(point)`.
template <class Candidates>
std::uint64_t find_all(const std::vector<PreparedArea>& areas, const std::vector<Vec3>& points,
                       const Candidates& candidates, std::uint64_t& containing) {
  std::uint64_t sum = 0;
  for (const Vec3& point : points)
    for (const std::uint32_t i : candidates(point))
      if (areas[i].certainly_contains(point)) sum += i + 1, ++containing;
  return sum;
}

LookupResult measure(int count, const std::vector<Vec3>& points, std::uint64_t seed) {
  LookupResult result;
  result.areas = count;
  std::vector<PreparedArea> areas;
  std::vector<std::uint32_t> all;
  for (int i = 0; i < count; ++i) {
    scene::Random random(seed, static_cast<std::uint64_t>(i), kAreaStream);
    areas.emplace_back(random_area(random));
    all.push_back(static_cast<std::uint32_t>(i));
  }
  const influence::AreaOctree octree(areas, {-1, -1, -1}, {1, 1, 1});
  result.cells = octree.cells();
  std::uint64_t named = 0, by_octree = 0, by_each = 0;
  for (const Vec3& point : points) named += octree.at(point).size();
  const ThreadStopwatch octree_watch;
  const std::uint64_t octree_sum = find_all(
      areas, points, [&](const Vec3& p) { return octree.at(p); }, by_octree);
  result.octree_seconds = octree_watch.seconds() / kPoints;
  const ThreadStopwatch linear_watch;
  const std::uint64_t linear_sum = find_all(
      areas, points, [&](const Vec3&) { return std::span<const std::uint32_t>(all); }, by_each);
  result.linear_seconds = linear_watch.seconds() / kPoints;
  result.agree = octree_sum == linear_sum && by_octree == by_each;
  result.containing = double(by_each) / kPoints;
  result.named = double(named) / kPoints;
  return result;
}

}  // namespace

std::vector<LookupResult> measure_lookups(std::uint64_t seed) {
  std::vector<Vec3> points;
  for (int i = 0; i < kPoints; ++i) {
    scene::Random random(seed, static_cast<std::uint64_t>(i), kPointStream);
    points.push_back(Vec3{static_cast<float>(random.between(-1, 1)), static_cast<float>(random.between(-1, 1)),
                          static_cast<float>(random.between(-1, 1))});
  }
  std::vector<LookupResult> results;
  for (const int count : kCounts) results.push_back(measure(count, points, seed));
  return results;
}

}  // namespace ctu::sim::paper
