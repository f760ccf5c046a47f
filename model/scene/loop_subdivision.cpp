#include "model/scene/loop_subdivision.h"

#include <fmt/core.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "model/base/error.h"

namespace ctu::scene {
namespace {

using Corners = std::array<std::uint32_t, 3>;

struct Edge {
  std::uint32_t end[2];
  std::uint32_t across[2] = {};  ///< the third corners of its triangles
  int triangles = 0;
};

/// What the weights ask of a mesh. Edges are numbered as the triangles first name them, so sums have one order.
class Topology {
 public:
  Topology(const ControlMesh& mesh, const Place& where) : around_(mesh.vertices.size()) {
    edges_of_.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) add_triangle(t, mesh.triangles[t], where);
    for (const Edge& edge : edges_)
      for (int i = 0; i < 2; ++i) {
        Ring& ring = around_[edge.end[i]];
        ring.neighbours.push_back(edge.end[1 - i]);
        if (edge.triangles == 1) ring.on_boundary.push_back(edge.end[1 - i]);
      }
  }

  struct Ring {
    std::vector<std::uint32_t> neighbours, on_boundary;
  };
  const Ring& around(std::size_t vertex) const { return around_[vertex]; }
  const std::vector<Edge>& edges() const { return edges_; }
  /// The edge from corner i to the next one.
  std::uint32_t edge_of(std::size_t triangle, int i) const { return edges_of_[triangle][static_cast<std::size_t>(i)]; }

 private:
  void add_triangle(std::size_t t, const Corners& corners, const Place& where) {
    Corners& own = edges_of_.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
      if (a == b)
        throw Error(where.text(), fmt::format("triangle {} of the control mesh names vertex {} twice", t, a),
                    "remove the triangle");
      const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
      const auto [at, is_new] = number_.try_emplace(key, static_cast<std::uint32_t>(edges_.size()));
      if (is_new) edges_.push_back({{a, b}});
      Edge& edge = edges_[at->second];
      if (edge.triangles == 2)
        throw Error(where.text(), fmt::format("more than two triangles of the control mesh share edge {} {}", a, b),
                    "cut the mesh there");
      edge.across[edge.triangles++] = corners[(i + 2) % 3];
      own[i] = at->second;
    }
  }

  std::unordered_map<std::uint64_t, std::uint32_t> number_;
  std::vector<Edge> edges_;
  std::vector<Corners> edges_of_;
  std::vector<Ring> around_;
};

double inner_weight(double valence) { return valence == 3 ? 3.0 / 16 : 3 / (8 * valence); }

/// `vertex` moved toward the mean of `others`: they get `weight` together.
Vector64 blend(const ControlMesh& mesh, std::size_t vertex, const std::vector<std::uint32_t>& others, double weight) {
  Vector64 sum;
  for (const std::uint32_t other : others) sum = sum + mesh.vertices[other];
  return mesh.vertices[vertex] * (1 - weight) + sum * (weight / static_cast<double>(others.size()));
}

/// Each vertex moved by the weight that its neighbours have together: `boundary`, or `inner` of their number.
template <class Inner>
std::vector<Vector64> moved_vertices(const ControlMesh& mesh, const Topology& topology, double boundary, Inner inner) {
  std::vector<Vector64> moved;
  moved.reserve(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Topology::Ring& ring = topology.around(v);
    if (ring.neighbours.empty())
      moved.push_back(mesh.vertices[v]);
    else if (!ring.on_boundary.empty())
      moved.push_back(blend(mesh, v, ring.on_boundary, boundary));
    else
      moved.push_back(blend(mesh, v, ring.neighbours, inner(static_cast<double>(ring.neighbours.size()))));
  }
  return moved;
}

Vector64 edge_vertex(const ControlMesh& mesh, const Edge& edge) {
  const auto& v = mesh.vertices;
  const Vector64 ends = v[edge.end[0]] + v[edge.end[1]];
  if (edge.triangles == 1) return ends * 0.5;
  return ends * (3.0 / 8) + (v[edge.across[0]] + v[edge.across[1]]) * (1.0 / 8);
}

}  // namespace

ControlMesh subdivide_loop(const ControlMesh& mesh, const Place& where) {
  const Topology topology(mesh, where);
  ControlMesh finer;
  finer.vertices = moved_vertices(mesh, topology, 1.0 / 4, [](double n) { return n * inner_weight(n); });
  const auto first_edge = static_cast<std::uint32_t>(finer.vertices.size());
  for (const Edge& edge : topology.edges()) finer.vertices.push_back(edge_vertex(mesh, edge));
  finer.triangles.reserve(4 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const std::uint32_t ab = first_edge + topology.edge_of(t, 0), bc = first_edge + topology.edge_of(t, 1),
                        ca = first_edge + topology.edge_of(t, 2);
    for (const Corners& part : {Corners{a, ab, ca}, Corners{b, bc, ab}, Corners{c, ca, bc}, Corners{ab, bc, ca}})
      finer.triangles.push_back(part);
  }
  return finer;
}

ControlMesh on_limit_surface(const ControlMesh& mesh, const Place& where) {
  const Topology topology(mesh, where);
  const auto inner = [](double n) { return n / (n + 3 / (8 * inner_weight(n))); };
  return {moved_vertices(mesh, topology, 1.0 / 3, inner), mesh.triangles};
}

}  // namespace ctu::scene
