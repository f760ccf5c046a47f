// What the sources of outcomes share: replay_source.h feeds recorded outcomes, exec_source.h computes them. A stage
// asks its source at the moment it takes a token; which source it is, is a template parameter of the whole unit.
#pragma once

#include <cstdint>
#include <string>

#include "model/base/error.h"
#include "model/intersect/ray.h"
#include "model/pipeline/context.h"
#include "model/reference/step.h"

namespace ctu::pipeline {

/// The mask test's answers for a node.
struct MaskAnswer {
  std::uint8_t survivors = 0;  ///< bit lane
  std::uint8_t uncertain = 0;  ///< bit lane
};

/// Of the lanes asked, in lane order: packed cull::CellKey (0 for comparators), and where object masks are compressed
/// the lane's entry of the compression LUT.
struct LaneKeys {
  int count = 0;
  std::uint32_t key[intersect::kLanes] = {};
  std::uint32_t mask_index[intersect::kLanes] = {};
};

/// Recorded steps and image do not belong together, or the unit is wrong: never a matter of timing.
[[noreturn]] inline void throw_event_mismatch(const Context& context, std::string what) {
  throw Error("ray " + std::to_string(context.ray) + ", visit " + std::to_string(context.visits), std::move(what),
              "record the trace again from this scene with these culling options");
}

}  // namespace ctu::pipeline
