// Hair as triangles: each strand becomes a thin ribbon, two triangles a segment, or a tube, two triangles a side of
// each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scene/draft.h"
#include "model/scene/vector64.h"

namespace ctu::scene {

struct StrandPoint {
  Vector64 position;
  double width = 0;  ///< of the ribbon or tube here, in scene units
};

/// Makes room for that many points of strands, of which `strands` are the first; throws Error at `where` if the scene
/// would get too large.
void require_room_for_strands(const std::string& where, std::uint64_t strands, std::uint64_t points, Draft& draft);

/// Appends one strand (at least two points) with LoadOptions::strand_sides and counts it in the report: a ribbon whose
/// two edges, or an open tube whose corners, lie half a width from each point. At its root it is turned about itself by
/// an angle drawn from `number`, so that neighbours face all ways and no axis is preferred; from there its direction is
/// carried along, always across the strand. Throws Error if the scene gets full.
void append_strand(const std::vector<StrandPoint>& points, std::uint64_t number, const std::string& where,
                   Draft& draft);

}  // namespace ctu::scene
