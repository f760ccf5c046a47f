// Hair as triangles: each strand becomes a thin ribbon, two triangles a segment.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scene/draft.h"
#include "model/scene/vector64.h"

namespace ctu::scene {

struct StrandPoint {
  Vector64 position;
  double width = 0;  ///< of the ribbon here, in scene units
};

/// Appends the ribbon of one strand (at least two points) and counts it in the report. At its root the ribbon is turned
/// about the strand by an angle drawn from `number`, so that ribbons of neighbours face all ways and no axis is
/// preferred; from there its direction is carried along, always across the strand. Throws Error if the scene gets full.
void append_ribbon(const std::vector<StrandPoint>& points, std::uint64_t number, const std::string& where,
                   Draft& draft);

}  // namespace ctu::scene
