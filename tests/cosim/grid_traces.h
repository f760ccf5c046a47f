// The rays and scenes of the co-simulation grid: what a unit meets, and what it should never meet.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/cosim/rtl_unit.h"
#include "tests/pipeline/world.h"

namespace ctu::cosim {

/// Hair, cards one inside the other, shadow rays, any-hit rays, a single ray, and hostile rays.
inline const std::vector<std::string>& grid_traces() {
  static const std::vector<std::string> names = {"hair", "interior", "shadow", "any-hit", "single", "hostile"};
  return names;
}

/// A world that the build can run: its design, masks, boxes, leaves and kinds of primitives; `rays`: about how many.
/// Rays travel in `packets`, if there are any: then most of those of a packet keep together; of several `trees`, each
/// over the whole scene, they walk now one and now another.
/// Same name and parameters: the same world.
std::unique_ptr<test::World> make_grid_world(const std::string& trace, const RtlParameters& build, int rays,
                                             const reference::PacketPlan& packets = {}, int trees = 1);

}  // namespace ctu::cosim
