// The rays and scenes of the co-simulation grid: what a unit meets, and what it should never meet.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/pipeline/world.h"

namespace ctu::cosim {

/// Hair, cards one inside the other, shadow rays, any-hit rays, a single ray, and hostile rays.
inline const std::vector<std::string>& grid_traces() {
  static const std::vector<std::string> names = {"hair", "interior", "shadow", "any-hit", "single", "hostile"};
  return names;
}

/// `box_bits` of a coordinate of the nodes' boxes; `rays`: about how many. Same name, masks and numbers: the same
/// world.
std::unique_ptr<test::World> make_grid_world(const std::string& trace, cull::Design design,
                                             const cull::MaskOptions& masks, std::uint32_t box_bits, int rays);

}  // namespace ctu::cosim
