// A ray's way through the unit, visit by visit: what viewers show as one row, or as one slice.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/pipeline/timeline.h"

namespace ctu::sim {

/// From the scheduler to the scheduler, or for the first and the last visit from and to the ends of the unit. A
/// packet's visits are those of its first ray.
struct RayVisit {
  std::uint64_t ray = 0;
  pipeline::Slot slot = 0;
  std::vector<pipeline::RayStay> stays;      ///< one behind the other without a gap
  std::optional<pipeline::Event> outcome{};  ///< none: the window has not seen it, or there is none
  bool follows = false;                      ///< the visit before it in the list is the same ray's

  pipeline::Cycle begin() const { return stays.front().begin; }
  pipeline::Cycle end() const { return stays.back().end; }
  bool enters() const { return stays.front().enters; }
  bool leaves() const { return stays.back().leaves; }
};

/// All visits of a timeline: context after context, in the order of time.
std::vector<RayVisit> ray_visits(const pipeline::Timeline& timeline);

/// Boxes were hit, and the mask test has thrown all of them away.
bool is_all_culled(const RayVisit& visit);

/// "visit 3: node 17, 3 hit, 1 culled"; without an outcome "visit".
std::string describe(const RayVisit& visit);

}  // namespace ctu::sim
