#include "sim/metamorph/closed_parts.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "traces/sampling.h"

namespace ctu::sim::metamorph {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// For each vertex the first one at its place.
std::vector<std::uint32_t> first_at_place(const std::vector<Vec3>& vertices) {
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::tie(vertices[i].x, vertices[i].y, vertices[i].z); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i - 1]) == key(order[i]) ? first[order[i - 1]] : order[i];
  return first;
}

/// An edge as one of its triangles runs along it.
struct Side {
  std::uint32_t low, high, triangle;
  bool upwards;  ///< from the lower to the higher vertex
};

std::vector<Side> sides_of(const std::vector<Corners>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t a = triangles[t][e], b = triangles[t][(e + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

/// Sets of triangles, and of each whether it is wound as the first one of its set.
class Parts {
 public:
  explicit Parts(std::size_t triangles) : parent_(triangles), turned_(triangles), open_(triangles) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  struct Place {
    std::uint32_t root;
    bool turned;
  };
  Place find(std::uint32_t triangle) {
    std::uint32_t root = triangle;
    bool turned = false;
    while (parent_[root] != root) {
      turned ^= turned_[root];
      root = parent_[root];
    }
    for (bool rest = turned; parent_[triangle] != root && triangle != root;) {
      const std::uint32_t next = parent_[triangle];
      const bool step = turned_[triangle];
      parent_[triangle] = root;
      turned_[triangle] = rest;
      rest ^= step;
      triangle = next;
    }
    return {root, turned};
  }

  /// `against`: one of the two must be turned for them to be wound alike.
  void join(std::uint32_t a, std::uint32_t b, bool against) {
    const Place at_a = find(a), at_b = find(b);
    const bool turn = at_a.turned ^ at_b.turned ^ against;
    if (at_a.root == at_b.root) {
      open_[at_a.root] = open_[at_a.root] || turn;  // a part that cannot be wound encloses nothing
      return;
    }
    parent_[at_b.root] = at_a.root;
    turned_[at_b.root] = turn;
    open_[at_a.root] = open_[at_a.root] || open_[at_b.root];
  }
  void leave_open(std::uint32_t triangle) { open_[find(triangle).root] = true; }
  bool is_open(std::uint32_t root) const { return open_[root]; }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<bool> turned_, open_;
};

void join_along_edges(const std::vector<Side>& sides, Parts& parts) {
  for (std::size_t first = 0, last; first < sides.size(); first = last) {
    for (last = first + 1;
         last < sides.size() && sides[last].low == sides[first].low && sides[last].high == sides[first].high;)
      ++last;
    for (std::size_t i = first + 1; i < last; ++i)
      parts.join(sides[first].triangle, sides[i].triangle, sides[first].upwards == sides[i].upwards);
    if (last - first != 2) parts.leave_open(sides[first].triangle);
  }
}

/// Six times the volume under the triangle, seen from `apex`.
double volume(const scene::Mesh& mesh, const Corners& t, const Vec3& apex) {
  const auto from_apex = [&](std::size_t i) { return traces::widen(mesh.vertices[t[i]]) - traces::widen(apex); };
  return traces::dot(from_apex(0), traces::cross(from_apex(1), from_apex(2)));
}

}  // namespace

ClosedParts closed_parts(const scene::Mesh& mesh) {
  const std::vector<std::uint32_t> place = first_at_place(mesh.vertices);
  std::vector<Corners> triangles;
  for (const Corners& t : mesh.triangles) {
    const Corners at{place[t[0]], place[t[1]], place[t[2]]};
    if (at[0] != at[1] && at[1] != at[2] && at[2] != at[0]) triangles.push_back(at);
  }
  Parts parts(triangles.size());
  join_along_edges(sides_of(triangles), parts);

  std::vector<double> volumes(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto [root, turned] = parts.find(t);
    if (turned) std::swap(triangles[t][1], triangles[t][2]);
    if (!parts.is_open(root)) volumes[root] += volume(mesh, triangles[t], mesh.vertices[triangles[root][0]]);
  }
  ClosedParts closed;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t root = parts.find(t).root;
    if (parts.is_open(root)) continue;
    closed.parts += root == t ? 1 : 0;
    if (volumes[root] < 0) std::swap(triangles[t][1], triangles[t][2]);
    closed.triangles.push_back(triangles[t]);
  }
  return closed;
}

}  // namespace ctu::sim::metamorph
