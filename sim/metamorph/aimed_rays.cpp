#include "sim/metamorph/aimed_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "traces/sampling.h"

namespace ctu::sim::metamorph {
namespace {

using intersect::Ray;
using traces::Vec3d;

constexpr double kLeastFacing = 0.05;  // cosine between the ray and each triangle's normal
constexpr int kRaysPerTarget = 4;
constexpr int kTriesPerRay = 4;

/// A point on the surface and the normals of the triangles there.
struct Target {
  Vec3 point;
  double edge = 0;  ///< length of the (shortest) edge there
  std::vector<Vec3d> normals;
};

/// One corner of one triangle, or one side: what is sorted to bring together what belongs together.
struct Corner {
  std::uint32_t vertex, triangle;
};
struct Side {
  std::uint32_t low, high, triangle;
};

/// The surface by its vertices and its edges.
class Surface {
 public:
  Surface(const scene::Mesh& mesh, const ClosedParts& closed) : mesh_(mesh), closed_(closed) {
    for (std::uint32_t t = 0; t < closed.triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = closed.triangles[t][i], b = closed.triangles[t][(i + 1) % 3];
        corners_.push_back({a, t});
        sides_.push_back({std::min(a, b), std::max(a, b), t});
      }
    std::sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) {
      return std::tie(a.vertex, a.triangle) < std::tie(b.vertex, b.triangle);
    });
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
      return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    for (std::size_t i = 0; i < corners_.size(); ++i)
      if (i == 0 || corners_[i].vertex != corners_[i - 1].vertex) first_corner_.push_back(i);
  }

  std::size_t edges() const { return sides_.size() / 2; }
  std::size_t vertices() const { return first_corner_.size(); }

  /// `along`: 0 to 1 from the edge's one vertex to the other.
  Target on_edge(std::size_t edge, double along) const {
    const Side &a = sides_[2 * edge], &b = sides_[2 * edge + 1];
    const Vec3d from = at(a.low), to = at(a.high) - from;
    return {traces::round_to_nearest(from + to * along), traces::length(to), {normal(a.triangle), normal(b.triangle)}};
  }

  Target at_vertex(std::size_t index) const {
    const std::size_t first = first_corner_[index];
    const std::size_t last = index + 1 < first_corner_.size() ? first_corner_[index + 1] : corners_.size();
    const std::uint32_t vertex = corners_[first].vertex;
    Target target{mesh_.vertices[vertex], std::numeric_limits<double>::infinity(), {}};
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t triangle = corners_[i].triangle;
      target.normals.push_back(normal(triangle));
      for (const std::uint32_t other : closed_.triangles[triangle])
        if (other != vertex) target.edge = std::min(target.edge, traces::length(at(other) - at(vertex)));
    }
    return target;
  }

 private:
  Vec3d at(std::uint32_t vertex) const { return traces::widen(mesh_.vertices[vertex]); }
  /// Of length one, or zero for a triangle without area: nothing faces that.
  Vec3d normal(std::uint32_t triangle) const {
    const auto& [a, b, c] = closed_.triangles[triangle];
    const Vec3d n = traces::cross(at(b) - at(a), at(c) - at(a));
    return traces::normalized(n, {0, 0, 0});
  }

  const scene::Mesh& mesh_;
  const ClosedParts& closed_;
  std::vector<Corner> corners_;
  std::vector<Side> sides_;
  std::vector<std::size_t> first_corner_;
};

bool faces_all(const Target& target, const Vec3d& inward) {
  return std::all_of(target.normals.begin(), target.normals.end(),
                     [&](const Vec3d& n) { return traces::dot(n, inward) <= -kLeastFacing; });
}

/// Against all normals there, and bent at random as far as the triangles allow.
std::optional<Vec3d> inward_direction(const Target& target, std::uint64_t seed, std::uint64_t number,
                                      std::uint32_t ray) {
  Vec3d sum;
  for (const Vec3d& n : target.normals) sum = sum - n;
  const Vec3d straight = traces::normalized(sum, {0, 0, 0});
  if (!faces_all(target, straight)) return std::nullopt;
  for (int attempt = 0; attempt < kTriesPerRay; ++attempt) {
    const auto random = traces::random_numbers(seed, number, ray, static_cast<std::uint32_t>(attempt));
    const Vec3d bent =
        traces::normalized(straight + traces::sphere_point(random[0], random[1]) * (1.5 * random[2]), straight);
    if (faces_all(target, bent)) return bent;
  }
  return straight;
}

/// The axis that the direction is nearest to.
Vec3d nearest_axis(const Vec3d& d) {
  const double x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  if (x >= y && x >= z) return {std::copysign(1.0, d.x), 0, 0};
  return y >= z ? Vec3d{0, std::copysign(1.0, d.y), 0} : Vec3d{0, 0, std::copysign(1.0, d.z)};
}

/// From `distance` before the target. Origin and direction are rounded, so it passes the target within rounding only;
/// nothing where that leaves no ray on which the triangles still face it.
void add_ray(const Target& target, const Vec3d& direction, double distance, bool outwards, AimedRays& aimed) {
  const Vec3 origin = traces::round_to_nearest(traces::widen(target.point) - direction * distance);
  const Vec3d way = traces::widen(target.point) - traces::widen(origin);
  const Vec3d inward = traces::normalized(way, {0, 0, 0}) * (outwards ? -1 : 1);
  const float infinity = std::numeric_limits<float>::infinity();
  const Ray ray{origin, 0, traces::round_to_nearest(way), infinity, intersect::RayKind::ClosestHit};
  if (!intersect::is_valid(ray) || !faces_all(target, inward)) return;
  aimed.rays.push_back({ray, static_cast<float>(1 + 1e-5 + 0.5 * target.edge / distance)});
}

double size_of(const scene::Mesh& mesh) {
  Vec3d lower = traces::widen(mesh.vertices[mesh.triangles.front()[0]]), upper = lower;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) {
      const Vec3& v = mesh.vertices[vertex];
      lower = {std::min<double>(lower.x, v.x), std::min<double>(lower.y, v.y), std::min<double>(lower.z, v.z)};
      upper = {std::max<double>(upper.x, v.x), std::max<double>(upper.y, v.y), std::max<double>(upper.z, v.z)};
    }
  return traces::length(upper - lower);
}

}  // namespace

AimedRays aim_at_edges(const scene::Mesh& mesh, const ClosedParts& closed, std::uint64_t seed, std::uint64_t most) {
  const Surface surface(mesh, closed);
  AimedRays aimed{{}, surface.edges(), surface.vertices(), 0};
  const double size = size_of(mesh);
  const std::uint64_t targets = 2 * surface.edges() + surface.vertices();
  // Odd, so that middles and random points of edges take turns.
  const std::uint64_t stride = most == 0 ? 1 : (targets * kRaysPerTarget + most - 1) / most | 1;
  const auto target_of = [&](std::uint64_t number) {
    if (number >= 2 * surface.edges()) return surface.at_vertex(number - 2 * surface.edges());
    const double random = traces::random_numbers(seed, number, 0, 0)[0];
    return surface.on_edge(number / 2, number % 2 == 0 ? 0.5 : random);
  };
  for (std::uint64_t number = 0; number < targets; number += stride) {
    const Target target = target_of(number);
    const auto near = inward_direction(target, seed, number, 1);
    if (!near) {
      ++aimed.folds;
      continue;
    }
    add_ray(target, *near, 4 * target.edge, false, aimed);
    const double far = number / stride % 8 == 0 ? 1000 : 2;
    add_ray(target, *inward_direction(target, seed, number, 2), far * size, false, aimed);
    const Vec3d axis = nearest_axis(*near);
    if (faces_all(target, axis)) add_ray(target, axis, size, false, aimed);
    add_ray(target, *inward_direction(target, seed, number, 3) * -1, target.edge, true, aimed);
  }
  return aimed;
}

}  // namespace ctu::sim::metamorph
