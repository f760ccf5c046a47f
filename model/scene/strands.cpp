#include "model/scene/strands.h"

#include "model/scene/random.h"
#include "model/scene/turn.h"

namespace ctu::scene {
namespace {

constexpr std::uint64_t kRibbonSeed = 0x726962626f6e;  // any constant: the same file gives the same triangles

// The strand's direction at point i: from its neighbour before to its neighbour behind.
Vector64 direction_at(const std::vector<StrandPoint>& points, std::size_t i, const Vector64& otherwise) {
  const std::size_t before = i == 0 ? 0 : i - 1;
  const std::size_t behind = i + 1 == points.size() ? i : i + 1;
  return normalized(points[behind].position - points[before].position, otherwise);
}

}  // namespace

void append_ribbon(const std::vector<StrandPoint>& points, std::uint64_t number, const std::string& where,
                   Draft& draft) {
  draft.require_room(where, 2 * points.size(), 2 * (points.size() - 1));
  auto& [vertices, triangles] = draft.mesh;
  Vector64 along = direction_at(points, 0, {0, 0, 1});
  const Turn start = turn(Random(kRibbonSeed, number).unit());
  const Vector64 u = any_across(along), v = cross(along, u);
  Vector64 across = u * start.cosine + v * start.sine;
  for (std::size_t i = 0; i < points.size(); ++i) {
    along = direction_at(points, i, along);
    across = normalized(across - along * dot(across, along), any_across(along));
    const Vector64 half = across * (0.5 * points[i].width);
    vertices.push_back((points[i].position - half).rounded());
    vertices.push_back((points[i].position + half).rounded());
    if (i == 0) continue;
    const auto last = static_cast<std::uint32_t>(vertices.size() - 1);
    triangles.push_back({last - 3, last - 2, last - 1});
    triangles.push_back({last - 2, last, last - 1});
  }
  ++draft.report.strands;
  draft.report.segments += points.size() - 1;
}

}  // namespace ctu::scene
