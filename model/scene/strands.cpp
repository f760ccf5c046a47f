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

/// The corners of a strand's cross section, in units of half its width along two directions across it.
std::vector<Turn> corners_of(int sides) {
  std::vector<Turn> corners;
  for (int side = 0; side < sides; ++side) corners.push_back(turn(0.5 + static_cast<double>(side) / sides));
  return corners;
}

/// Two triangles for each side between the corners of the last two points; a ribbon has one side.
void append_sides(std::uint32_t corners, Mesh& mesh) {
  const auto near = static_cast<std::uint32_t>(mesh.vertices.size()) - 2 * corners, far = near + corners;
  const std::uint32_t sides = corners == 2 ? 1 : corners;
  for (std::uint32_t side = 0; side < sides; ++side) {
    const std::uint32_t next = (side + 1) % corners;
    mesh.triangles.push_back({near + side, near + next, far + side});
    mesh.triangles.push_back({near + next, far + next, far + side});
  }
}

}  // namespace

void require_room_for_strands(const std::string& where, std::uint64_t strands, std::uint64_t points, Draft& draft) {
  const auto corners = static_cast<std::uint64_t>(draft.options.strand_sides);
  draft.require_room(where, corners * points, (corners == 2 ? 2 : 2 * corners) * (points - strands));
}

void append_strand(const std::vector<StrandPoint>& points, std::uint64_t number, const std::string& where,
                   Draft& draft) {
  require_room_for_strands(where, 1, points.size(), draft);
  const std::vector<Turn> corners = corners_of(draft.options.strand_sides);
  Vector64 along = direction_at(points, 0, {0, 0, 1});
  const Turn start = turn(Random(kRibbonSeed, number).unit());
  const Vector64 u = any_across(along), v = cross(along, u);
  Vector64 across = u * start.cosine + v * start.sine;
  for (std::size_t i = 0; i < points.size(); ++i) {
    along = direction_at(points, i, along);
    across = normalized(across - along * dot(across, along), any_across(along));
    const Vector64 half = across * (0.5 * points[i].width), other = cross(along, half);
    for (const Turn& corner : corners)
      draft.mesh.vertices.push_back((points[i].position + half * corner.cosine + other * corner.sine).rounded());
    if (i > 0) append_sides(static_cast<std::uint32_t>(corners.size()), draft.mesh);
  }
  ++draft.report.strands;
  draft.report.segments += points.size() - 1;
}

}  // namespace ctu::scene
