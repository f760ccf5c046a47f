#include "model/influence/find_areas.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/influence/light_fit.h"

namespace ctu::influence {
namespace {

using scene::Vector64;

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kOneFrustumCosine = 0.5;  // rays up to 60 degrees off the middle fit one frustum
constexpr double kBehind = 1e-3;           // how far the apex lies behind the light, in lengths of the longest ray
constexpr int kTurns = 16;                 // a quarter turn of a cross-section is tried in so many steps

void check(const FindOptions& o) {
  const char* const where = "influence areas";
  if (o.most_areas < 0) throw Error(where, fmt::format("at most {} of them", o.most_areas), "give 0 or more");
  if (!(o.least_share > 0 && o.least_share <= 1))
    throw Error(where, fmt::format("a least share of {}", o.least_share), "give more than 0, at most 1");
  if (!(o.tolerance_degrees > 0 && o.tolerance_degrees < 90))
    throw Error(where, fmt::format("a tolerance of {} degrees", o.tolerance_degrees), "give more than 0, below 90");
  if (o.guesses < 1 || o.most_rays < 2) throw Error(where, "no guess can be made", "give 1 guess and 2 rays or more");
  if (!(o.margin >= 0 && std::isfinite(o.margin))) throw Error(where, "a margin below 0", "give 0 or more");
}

/// Where the ray ends, or leaves the box; its origin when it never meets it.
Vector64 end_of(const intersect::Ray& ray, const Vec3& lower, const Vec3& upper) {
  double end = ray.tmax;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis], o = ray.origin[axis];
    if (d != 0) end = std::min(end, ((d > 0 ? upper[axis] : lower[axis]) - o) / d);
  }
  return Vector64(ray.origin) + Vector64(ray.direction) * std::max(end, 0.0);
}

std::vector<Sight> sights_of(std::span<const intersect::Ray> rays, const Vec3& lower, const Vec3& upper,
                             std::size_t most) {
  std::vector<Sight> sights;
  const std::size_t count = std::min(rays.size(), most);
  for (std::size_t i = 0; i < count; ++i) {
    const intersect::Ray& ray = rays[i * rays.size() / count];
    if (!intersect::is_valid(ray)) continue;
    const Vector64 direction = normalized(Vector64(ray.direction), {0, 0, 0});
    if (scene::dot(direction, direction) == 0) continue;
    sights.push_back({Vector64(ray.origin), direction, end_of(ray, lower, upper)});
  }
  return sights;
}

using Bundle = std::vector<Sight>;

/// What the ends of rays span in a frame; in a point area after division by the distance.
struct Reach {
  double low[3] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  double high[3] = {-low[0], -low[0], -low[0]};

  void grow(double x, double y, double z) {
    const double q[3] = {x, y, z};
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], q[i]);
      high[i] = std::max(high[i], q[i]);
    }
  }
  double middle(int i) const { return 0.5 * (low[i] + high[i]); }
  double half(int i) const { return 0.5 * (high[i] - low[i]); }
};

Reach reach_of(const Bundle& bundle, const InfluenceArea& area, bool divide) {
  const Vector64 o(area.origin), u(area.axes[0]), v(area.axes[1]), w(area.axes[2]);
  Reach reach;
  for (const Sight& sight : bundle)
    for (const Vector64& p : {sight.origin, sight.end}) {
      const Vector64 q = p - o;
      const double z = scene::dot(q, w), scale = divide ? 1 / z : 1;
      reach.grow(scene::dot(q, u) * scale, scene::dot(q, v) * scale, z);
    }
  return reach;
}

/// Turns the cross-section to where it is smallest.
void turn_to_smallest(InfluenceArea& area, const Bundle& bundle, bool divide) {
  const Vector64 u(area.axes[0]), v(area.axes[1]);
  double smallest = std::numeric_limits<double>::infinity();
  std::array<Vec3, 3> best = area.axes;
  for (int turn = 0; turn < kTurns; ++turn) {
    const double angle = 90 * kDegree * turn / kTurns;
    area.axes = frame_along(area.axes[2], (u * std::cos(angle) + v * std::sin(angle)).rounded());
    const Reach reach = reach_of(bundle, area, divide);
    const double size = reach.half(0) * reach.half(1);
    if (size < smallest) smallest = size, best = area.axes;
  }
  area.axes = best;
}

float wider(double x, double margin) { return static_cast<float>(x * (1 + margin) * (1 + 0x1p-20)); }

InfluenceArea plane_area(const Vector64& direction, const Bundle& bundle, double margin) {
  InfluenceArea area;
  area.axes = frame_along(direction.rounded(), any_across(direction).rounded());
  area.origin = bundle.front().origin.rounded();
  turn_to_smallest(area, bundle, false);
  Reach reach = reach_of(bundle, area, false);
  const Vector64 u(area.axes[0]), v(area.axes[1]);
  area.origin = (Vector64(area.origin) + u * reach.middle(0) + v * reach.middle(1)).rounded();
  reach = reach_of(bundle, area, false);
  const double room = margin * std::max({reach.half(0), reach.half(1), reach.half(2)});  // flat bundles get some too
  area.half_x = wider(std::max(std::fabs(reach.low[0]), reach.high[0]) + room, 0);
  area.half_y = wider(std::max(std::fabs(reach.low[1]), reach.high[1]) + room, 0);
  area.near = static_cast<float>(reach.low[2] - room);
  area.far = static_cast<float>(reach.high[2] + room);
  return area;
}

InfluenceArea point_area(const Vector64& light, const Vector64& axis, const Bundle& bundle, double margin) {
  InfluenceArea area;
  area.kind = AreaKind::Point;
  area.axes = frame_along(axis.rounded(), any_across(axis).rounded());
  double longest = 0;
  for (const Sight& sight : bundle) longest = std::max(longest, scene::length(sight.origin - light));
  const double behind = kBehind * longest;
  area.origin = (light - Vector64(area.axes[2]) * behind).rounded();
  turn_to_smallest(area, bundle, true);
  const Reach reach = reach_of(bundle, area, true);
  area.half_x = wider(std::max(std::fabs(reach.low[0]), reach.high[0]) + margin * 0.1, margin);
  area.half_y = wider(std::max(std::fabs(reach.low[1]), reach.high[1]) + margin * 0.1, margin);
  area.near = static_cast<float>(std::max(0.5 * reach.low[2], 0.0));
  area.far = wider(reach.high[2], margin);
  return area;
}

/// The side of a cube around the light on which the vector from it ends: 0 to 5.
int side_of(const Vector64& v) {
  const double size[3] = {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
  const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
  const double at = axis == 0 ? v.x : axis == 1 ? v.y : v.z;
  return 2 * axis + (at < 0 ? 1 : 0);
}

Vector64 axis_of_side(int side) {
  const double sign = side % 2 == 0 ? 1 : -1;
  return {side / 2 == 0 ? sign : 0, side / 2 == 1 ? sign : 0, side / 2 == 2 ? sign : 0};
}

/// The middle of the cone of directions from the light, or nothing when one frustum cannot hold it.
std::optional<Vector64> middle_of_cone(const Vector64& light, const Bundle& bundle) {
  Vector64 low{1, 1, 1}, high{-1, -1, -1};
  for (const Sight& s : bundle) {
    const Vector64 d = normalized(s.origin - light, {0, 0, 0});
    low = {std::min(low.x, d.x), std::min(low.y, d.y), std::min(low.z, d.z)};
    high = {std::max(high.x, d.x), std::max(high.y, d.y), std::max(high.z, d.z)};
  }
  const Vector64 middle = normalized(low + high, {0, 0, 0});
  for (const Sight& s : bundle)
    if (!(scene::dot(s.origin - light, middle) >= kOneFrustumCosine * scene::length(s.origin - light)))
      return std::nullopt;
  return middle;
}

/// Rays so far out that binary32 has no numbers for their area go without.
void add(const InfluenceArea& area, const Bundle& bundle, std::vector<FoundArea>& areas) {
  if (problem_of(area) == nullptr) areas.push_back({area, bundle.size()});
}

void add_point_areas(const Vector64& light, Bundle bundle, std::size_t least_rays, double margin,
                     std::vector<FoundArea>& areas) {
  for (Sight& sight : bundle)  // beyond the light they run apart
    if (scene::dot(sight.end - light, sight.direction) > 0) sight.end = light;
  if (const auto middle = middle_of_cone(light, bundle)) {
    add(point_area(light, *middle, bundle, margin), bundle, areas);
    return;
  }
  Bundle sides[6];
  for (const Sight& sight : bundle) sides[side_of(sight.origin - light)].push_back(sight);
  for (int side = 0; side < 6; ++side)
    if (sides[side].size() >= least_rays)
      add(point_area(light, axis_of_side(side), sides[side], margin), sides[side], areas);
}

}  // namespace

std::vector<InfluenceArea> FoundAreas::list() const {
  std::vector<InfluenceArea> all;
  for (const FoundArea& found : areas) all.push_back(found.area);
  return all;
}

FoundAreas find_areas(std::span<const intersect::Ray> rays, const Vec3& lower, const Vec3& upper,
                      const FindOptions& options) {
  check(options);
  FoundAreas found;
  std::vector<Sight> left = sights_of(rays, lower, upper, options.most_rays);
  found.looked_at = found.unclaimed = left.size();
  const double least_cosine = std::cos(options.tolerance_degrees * kDegree);
  const auto least_rays =
      static_cast<std::size_t>(std::max(2.0, std::ceil(options.least_share * static_cast<double>(left.size()))));
  for (std::uint64_t round = 0; left.size() >= least_rays; ++round) {
    const auto light = find_light(left, options.guesses, least_rays, least_cosine, options.seed, round);
    if (!light) break;
    Bundle bundle, others;
    for (const Sight& sight : left) (agrees(*light, sight, least_cosine) ? bundle : others).push_back(sight);
    if (light->kind == AreaKind::Plane)
      add(plane_area(light->place, bundle, options.margin), bundle, found.areas);
    else
      add_point_areas(light->place, bundle, least_rays, options.margin, found.areas);
    left = std::move(others);
    if (found.areas.size() >= static_cast<std::size_t>(options.most_areas)) break;
  }
  if (found.areas.size() > static_cast<std::size_t>(options.most_areas))
    found.areas.resize(static_cast<std::size_t>(options.most_areas));
  for (const FoundArea& area : found.areas) found.unclaimed -= area.rays;
  return found;
}

}  // namespace ctu::influence
